"""Intersections of rays and shapes in closed form, for many ray-shape pairs at once.

Rays start at `start` (3, ...) [m] along the unit vectors `way` (3, ...), both in the frame of the
shape, whose half extents are `half` (3, ...) [m]; the shapes broadcast. The functions return the
distances [m] at which a ray enters and leaves its shape: enter > leave is a miss; negative
distances are behind the start.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
_TINY = 1e-150  # replaces a zero denominator; its square does not underflow


def sphere(start: Floats, way: Floats, half: Floats) -> tuple[Floats, Floats]:
    """Intersect spheres at the origin."""
    middle = -(start * way).sum(axis=0)
    reach = middle * middle - (start * start).sum(axis=0) + half[0] * half[0]
    return _around(middle, reach)


def box(start: Floats, way: Floats, half: Floats) -> tuple[Floats, Floats]:
    """Intersect boxes at the origin."""
    inverse = 1.0 / _not_zero(way)
    middle = -start * inverse
    reach = np.abs(inverse) * half
    return (middle - reach).max(axis=0), (middle + reach).min(axis=0)


def cylinder(start: Floats, way: Floats, half: Floats) -> tuple[Floats, Floats]:
    """Intersect cylinders about z, centred at the origin."""
    (x, y, z), (dx, dy, dz), radius = start, way, half[0]
    across = np.maximum(dx * dx + dy * dy, _TINY)
    along = x * dx + y * dy
    reach = along * along - across * (x * x + y * y - radius * radius)
    enter, leave = _around(-along / across, reach, across)
    inverse = 1.0 / _not_zero(dz)
    middle, cap = -z * inverse, np.abs(inverse) * half[2]
    return np.maximum(enter, middle - cap), np.minimum(leave, middle + cap)


def _around(middle: Floats, square: Floats, per: Floats | float = 1.0) -> tuple[Floats, Floats]:
    """Return middle -+ sqrt(square) / per; for negative squares a miss."""
    root = np.sqrt(np.maximum(square, 0.0)) / per
    root[square < 0.0] = -np.inf
    return middle - root, middle + root


def _not_zero(way: Floats) -> Floats:
    return np.where(np.abs(way) < _TINY, _TINY, way)


def first_from(least: float, enter: Floats, leave: Floats) -> Floats:
    """Return the distance of the first hit at `least` [m] or beyond; inf without a hit.

    A ray that starts inside a shape hits its surface from within.
    """
    met = np.where(enter >= least, enter, leave)
    met[(enter > leave) | (met < least)] = np.inf
    return met
