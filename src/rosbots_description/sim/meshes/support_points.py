"""The support points of a set: the extreme points in given directions."""

import numpy as np

from ..core.arrays import FloatArray

_AT_ONCE = 1 << 14  # products, which fit in the processor's cache


def support_points(points: FloatArray, directions: FloatArray) -> list[int]:
    """Return the indices of the points (n, 3) that are extreme in any of the directions (m, 3).

    It computes sums of three products, not a matrix product: that would take gigabytes for a large
    mesh, and its ties would depend on the linear algebra library.
    """
    x, y, z = points.T.copy()
    count = max(1, _AT_ONCE // len(points))
    found: set[int] = set()
    for start in range(0, len(directions), count):
        a, b, c = directions[start : start + count].T[:, :, np.newaxis]
        found.update(np.argmax(a * x + b * y + c * z, axis=1).tolist())
    return sorted(found)
