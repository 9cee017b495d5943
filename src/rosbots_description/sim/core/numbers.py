"""Parses numbers."""

import math


def parse_numbers(text: str, count: int) -> tuple[float, ...] | None:
    """Return `count` finite numbers separated by blanks, or None for any other text."""
    parts = text.split()
    if len(parts) != count or '_' in text:
        return None
    try:
        values = tuple(float(part) for part in parts)
    except ValueError:
        return None
    return values if all(math.isfinite(value) for value in values) else None


def parse_number(text: str) -> float | None:
    """Return a finite number, or None for any other text."""
    values = parse_numbers(text, 1)
    return values[0] if values else None
