"""Numbers on a command line, for argparse."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Sequence
from decimal import Decimal

POSE = (  # letters of options, and what they mean
    ('x', 'position along x [m]'),
    ('y', 'position along y [m]'),
    ('z', 'position along z [m]'),
    ('R', 'roll [rad]'),
    ('P', 'pitch [rad]'),
    ('Y', 'yaw [rad]'),
)
_NEGATIVE_WITH_EXPONENT = re.compile(r'-(\d+\.?\d*|\.\d+)[eE][-+]?\d+')


def finite(text: str) -> float:
    """Return a finite number; the type of an argument."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f'{text!r} is not a finite number')
    return value


def without_exponents(arguments: Sequence[str]) -> list[str]:
    """Return the arguments with -1e-3 written as -0.001, which argparse reads as a number."""
    return [
        format(Decimal(text), 'f') if _NEGATIVE_WITH_EXPONENT.fullmatch(text) else text
        for text in arguments
    ]
