"""Reject numbers that are not finite, with the name of their field."""

import math

from genpy import Message

from ...sim.core import SimError


class RequestError(SimError):
    """A request that cannot be carried out as sent."""


def require_finite(message: Message) -> None:
    """Look through every field of a message.

    Raises:
        RequestError: a number is NaN or infinite; the sentence names it.

    """
    for field in message.__slots__:
        _require_finite(getattr(message, field), field)


def _require_finite(value: object, path: str) -> None:
    if isinstance(value, float):
        if not math.isfinite(value):
            raise RequestError(f'{path} is {value}; it must be a finite number')
    elif isinstance(value, Message):
        for field in value.__slots__:
            _require_finite(getattr(value, field), f'{path}.{field}')
    elif isinstance(value, list | tuple):
        for i, item in enumerate(value):
            _require_finite(item, f'{path}[{i}]')
