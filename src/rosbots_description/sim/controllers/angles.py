"""Differences of angles [rad]."""

import math

from ..description import CONTINUOUS


def shortest(start: float, end: float) -> float:
    """Return the shortest rotation from `start` to `end`, in [-pi, pi]; NaN between infinities."""
    way = end - start
    return math.nan if math.isinf(way) else math.remainder(way, math.tau)


def shortest_within(start: float, end: float, lower: float, upper: float) -> float:
    """Return the shorter rotation from `start` to `end` that ends within limits, if one does."""
    near = shortest(start, end)
    if lower <= start + near <= upper:
        return near
    far = near - math.copysign(math.tau, near)
    return far if lower <= start + far <= upper else near


def position_error(kind: str, actual: float, wanted: float, lower: float, upper: float) -> float:
    """Return the way from a joint's position to the wanted one, for its type in the URDF."""
    if kind == 'revolute':
        return shortest_within(actual, wanted, lower, upper)
    return shortest(actual, wanted) if kind == CONTINUOUS else wanted - actual
