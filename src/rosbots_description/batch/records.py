"""What is recorded in a run: a number of each reading, and its statistics."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypeGuard

import numpy as np

from ..sim import to_rpy

STATISTICS = 'end', 'min', 'max', 'mean'
_AXES = 'x', 'y', 'z', 'w'
_ANGLES = 'roll', 'pitch', 'yaw'
_OF_ALL: dict[str, Callable[[Any], Any]] = {
    'min': np.min,
    'max': np.max,
    'mean': np.mean,
    'count': np.size,
}


class JointReading(NamedTuple):
    """Position [rad or m] and velocity [rad/s or m/s] of a joint."""

    position: float
    velocity: float


def value_at(reading: object, path: str) -> float:
    """Return a number of a reading, by its names separated by dots.

    Names are those of a reading's fields, as `twist`; of a vector x, y, z; of an orientation roll,
    pitch, yaw or x, y, z, w; of any sequence an index, `min`, `max`, `mean` or `count`.

    Raises:
        ValueError: the reading has no such number; the message lists the names that it has.
    """
    part: Any = reading
    for name in path.split('.'):
        names = _names(part)
        if name.isdecimal() and _is_sequence(part) and int(name) < len(part):
            part = part[int(name)]
        elif name not in names:
            raise ValueError(
                f"'{path}' is not in a {type(reading).__name__}: there is no "
                f"'{name}' in it, but {', '.join(names) or 'only a number'}"
            )
        elif name in getattr(part, '_fields', ()):
            part = getattr(part, name)
        elif name in _ANGLES:
            part = to_rpy(part)[_ANGLES.index(name)]
        elif name in _AXES:
            part = part[_AXES.index(name)]
        else:
            part = _OF_ALL[name](part) if len(part) or name == 'count' else math.nan
    if not isinstance(part, bool | int | float | np.number):
        raise ValueError(f"'{path}' is not a number; it has {', '.join(_names(part))}")
    return float(part)


def _is_sequence(part: object) -> TypeGuard[Sequence[Any]]:
    return isinstance(part, tuple | list | np.ndarray) and not hasattr(part, '_fields')


def _names(part: object) -> tuple[str, ...]:
    if hasattr(part, '_fields'):
        return tuple(part._fields)
    if not _is_sequence(part):
        return ()
    axes = _AXES[: len(part)] if len(part) in (3, 4) else ()
    return (*axes, *(_ANGLES if len(part) == 4 else ()), *_OF_ALL)


class Statistics:
    """The last, least, greatest and mean of a series of numbers."""

    def __init__(self) -> None:
        self._count, self._sum = 0, 0.0
        self._end = self._min = self._max = math.nan

    def add(self, value: float) -> None:
        """Add the newest number."""
        self._min = value if not self._count else min(self._min, value)
        self._max = value if not self._count else max(self._max, value)
        self._end = value
        self._sum += value
        self._count += 1

    def columns(self, name: str) -> dict[str, float | None]:
        """Return them as `name_end` and so on; None without any number."""
        numbers = (self._end, self._min, self._max, self._sum / max(1, self._count))
        return {
            f'{name}_{statistic}': number if self._count else None
            for statistic, number in zip(STATISTICS, numbers, strict=True)
        }


class Records:
    """What is recorded in a run: the newest reading of each record, and statistics of numbers."""

    def __init__(self, paths: Mapping[str, str]) -> None:
        """Take the path, by record, of the number in its readings; '' for the reading itself."""
        self._paths = paths
        self.newest: dict[str, Any] = dict.fromkeys(paths)
        self._statistics = {name: Statistics() for name, path in paths.items() if path}

    def take(self, name: str, reading: object) -> None:
        """Record a reading.

        Raises:
            ValueError: it has no such number.
        """
        path = self._paths[name]
        self.newest[name] = value_at(reading, path) if path else reading
        if path:
            self._statistics[name].add(self.newest[name])

    def columns(self) -> dict[str, float | None]:
        """Return the statistics of all numbers, by column of a row."""
        found: dict[str, float | None] = {}
        for name, statistics in self._statistics.items():
            found |= statistics.columns(name)
        return found


def check_vectors(message: Mapping[str, Any], fields: tuple[str, ...]) -> list[tuple[float, ...]]:
    """Return the vectors (x, y, z) of a message's fields; what is left out is 0.

    Raises:
        ValueError: it has other fields, or a number is not finite.
    """
    if not isinstance(message, Mapping) or set(message) - set(fields):
        raise ValueError(
            f'the message has the fields {" and ".join(fields)}, each with x, y and '
            f'z; it is {message!r}'
        )
    vectors = []
    for field in fields:
        vector = message.get(field) or {}
        if not isinstance(vector, Mapping) or set(vector) - set('xyz'):
            raise ValueError(f'{field} has x, y and z; it is {vector!r}')
        for axis, number in vector.items():
            if not isinstance(number, int | float | np.number) or not math.isfinite(number):
                raise ValueError(f'{field}.{axis} is {number}; numbers must be finite')
        vectors.append(tuple(float(vector.get(axis, 0.0)) for axis in 'xyz'))
    return vectors
