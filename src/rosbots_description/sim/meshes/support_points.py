"""Which of many points reach farthest."""

import numpy as np

_AT_ONCE = 1 << 14  # products, so that they stay near the processor


def farthest(points: np.ndarray, ways: np.ndarray) -> list[int]:
    """Return the numbers of the points (n, 3) that are the farthest ones in some directions (m, 3).

    Sums of three products each, not a product of matrices: that would take gigabytes for a large
    mesh, and of two points equally far each library would take another.
    """
    x, y, z = points.T.copy()
    count = max(1, _AT_ONCE // len(points))
    found: set[int] = set()
    for start in range(0, len(ways), count):
        a, b, c = ways[start : start + count].T[:, :, np.newaxis]
        found.update(np.argmax(a * x + b * y + c * z, axis=1).tolist())
    return sorted(found)
