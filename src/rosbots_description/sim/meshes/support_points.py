"""The support points of a set: those that reach farthest in given directions."""

import numpy as np

from ..core.arrays import FloatArray

_AT_ONCE = 1 << 14  # products, so that they stay near the processor


def support_points(points: FloatArray, directions: FloatArray) -> list[int]:
    """Return the numbers of the points (n, 3) that reach farthest along any of directions (m, 3).

    Sums of three products each, not a product of matrices: that would take gigabytes for a large
    mesh, and of two points equally far each library would take another.
    """
    x, y, z = points.T.copy()
    count = max(1, _AT_ONCE // len(points))
    found: set[int] = set()
    for start in range(0, len(directions), count):
        a, b, c = directions[start : start + count].T[:, :, np.newaxis]
        found.update(np.argmax(a * x + b * y + c * z, axis=1).tolist())
    return sorted(found)
