"""Where rays meet shapes: closed formulas for many pairs of ray and shape at once.

A ray begins at `start` (3, p) and goes along `way` (3, p), unit vectors, both in the frame of its
shape, whose half extents are `half` (3, p) [m]. What comes back is how far [m] along its way a ray
enters and leaves; one that misses leaves before it enters. What is negative is behind the start.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
_TINY = 1e-150  # in place of zero, below a fraction; its square is a number still


def sphere(start: Floats, way: Floats, half: Floats) -> tuple[Floats, Floats]:
    """Meet balls about the origin."""
    middle = -(start * way).sum(axis=0)
    reach = middle * middle - (start * start).sum(axis=0) + half[0] * half[0]
    return _around(middle, reach)


def box(start: Floats, way: Floats, half: Floats) -> tuple[Floats, Floats]:
    """Meet cuboids about the origin."""
    inverse = 1.0 / _not_zero(way)
    middle = -start * inverse
    reach = np.abs(inverse) * half
    return (middle - reach).max(axis=0), (middle + reach).min(axis=0)


def cylinder(start: Floats, way: Floats, half: Floats) -> tuple[Floats, Floats]:
    """Meet cylinders about z, which end at half their length to both sides."""
    (x, y, z), (dx, dy, dz), radius = start, way, half[0]
    across = np.maximum(dx * dx + dy * dy, _TINY)
    along = x * dx + y * dy
    reach = along * along - across * (x * x + y * y - radius * radius)
    enter, leave = _around(-along / across, reach, across)
    inverse = 1.0 / _not_zero(dz)
    middle, cap = -z * inverse, np.abs(inverse) * half[2]
    return np.maximum(enter, middle - cap), np.minimum(leave, middle + cap)


def _around(middle: Floats, square: Floats, per: Floats | float = 1.0) -> tuple[Floats, Floats]:
    """Return middle -+ sqrt(square) / per; where there is no root, what says that a ray misses."""
    root = np.sqrt(np.maximum(square, 0.0)) / per
    root[square < 0.0] = -np.inf
    return middle - root, middle + root


def _not_zero(way: Floats) -> Floats:
    return np.where(np.abs(way) < _TINY, _TINY, way)


def first_from(least: float, enter: Floats, leave: Floats) -> Floats:
    """Return where a ray that begins `least` [m] on its way first meets a surface; inf: nowhere.

    One that begins inside meets the surface from within.
    """
    met = np.where(enter >= least, enter, leave)
    met[(enter > leave) | (met < least)] = np.inf
    return met
