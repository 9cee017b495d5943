"""Arrays of numpy, in a module of their own: modules without arrays need not import numpy."""

from typing import Any

import numpy as np

from .transforms import Quaternion, rotate

FloatArray = np.ndarray[Any, np.dtype[np.float64]]
IntArray = np.ndarray[Any, np.dtype[np.int64]]

_AXES = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
_UNIT = np.eye(3)


def rotation_matrix(orientation: Quaternion) -> FloatArray:
    """Return the rotation matrix (3, 3) of a unit quaternion."""
    x, y, z = (rotate(orientation, axis) for axis in _AXES)
    return np.array((x, y, z)).T


def _coefficients() -> FloatArray:
    """Return the coefficients (16, 9) of products of two components of a quaternion, x, y, z, w.

    A rotation matrix is the unit matrix and the sum of these products.
    """
    found = np.zeros((4, 4, 3, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        found[j, j, i, i] = found[k, k, i, i] = -2.0
        found[i, j, i, j] = found[i, j, j, i] = 2.0
        found[3, k, i, j], found[3, k, j, i] = -2.0, 2.0
    return found.reshape(16, 9)


_COEFFICIENTS = _coefficients()


def rotation_matrices(orientations: FloatArray) -> FloatArray:
    """Return the rotation matrices (n, 3, 3) of unit quaternions (n, 4)."""
    products = orientations[:, :, None] * orientations[:, None, :]
    matrices: FloatArray = _UNIT + (products.reshape(-1, 16) @ _COEFFICIENTS).reshape(-1, 3, 3)
    return matrices
