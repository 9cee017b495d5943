"""Numbers within messages, by rqt_plot's paths: `twist/twist/linear/x`, `position[0]`."""

import math
import re
from collections.abc import Callable
from typing import Any

import roslib.message
from genpy import Message

from ...sim.core import SimError

NUMBERS = {
    'bool',
    'byte',
    'char',
    'float32',
    'float64',
    *(f'{sign}int{bits}' for sign in ('', 'u') for bits in (8, 16, 32, 64)),
}


def number_paths(kind: type[Any]) -> tuple[str, ...]:
    """Return the paths of all numbers in messages of a class, of arrays the first element."""
    found: list[str] = []
    for name, (base, is_array) in _fields(kind).items():
        path = f'{name}[0]' if is_array else name
        if base in NUMBERS:
            found.append(path)
        elif name != 'header' and (inner := _class(base)) is not None:
            found += (f'{path}/{rest}' for rest in number_paths(inner))
    return tuple(found)


def number_getter(kind: type[Any], path: str) -> Callable[[Any], float]:
    """Return the function from messages of a class to the number at a path.

    It returns NaN where a message has no element of that index.

    Raises:
        SimError: there is no such number in them.
    """
    steps: list[tuple[str, int | None]] = []
    inner: type[Any] | None = kind
    base = kind._type
    for part in path.split('/'):
        fields = _fields(inner) if inner else {}
        found = re.fullmatch(r'(\w+)(?:\[(\d{1,9})\])?', part)
        if not found or found[1] not in fields:
            raise SimError(
                f"{base} has no field '{part}'"
                + (f'; it has {", ".join(fields)}.' if fields else '.')
            )
        name, index = found[1], found[2]
        field, is_array = fields[name]
        if is_array and index is None:
            raise SimError(f"'{name}' of {base} is an array; add an index, as in {name}[0].")
        if index is not None and not is_array:
            raise SimError(f"'{name}' of {base} is no array; leave out [{index}].")
        steps.append((name, None if index is None else int(index)))
        base, inner = field, _class(field)
    if base not in NUMBERS:
        raise SimError(f"'{path}' is not a number but a {base}.")

    def get(message: Message) -> float:
        for name, index in steps:
            message = getattr(message, name)
            if index is not None:
                if index >= len(message):
                    return math.nan
                message = message[index]
        return float(message)

    return get


def _fields(kind: type[Any]) -> dict[str, tuple[str, bool]]:
    """Return type, without brackets, of each field, and whether it is an array."""
    return {
        name: (told.partition('[')[0], '[' in told)
        for name, told in zip(kind.__slots__, kind._slot_types, strict=True)
    }


def _class(base: str) -> type[Any] | None:
    return roslib.message.get_message_class(base) if '/' in base else None
