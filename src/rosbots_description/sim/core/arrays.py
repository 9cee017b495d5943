"""Arrays of numpy, in a module of their own: modules without arrays need not import numpy."""

from typing import Any

import numpy as np

from .transforms import Quaternion, rotate

FloatArray = np.ndarray[Any, np.dtype[np.float64]]
IntArray = np.ndarray[Any, np.dtype[np.int64]]

_AXES = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def rotation_matrix(orientation: Quaternion) -> FloatArray:
    """Return the rotation matrix (3, 3) of a unit quaternion."""
    x, y, z = (rotate(orientation, axis) for axis in _AXES)
    return np.array((x, y, z)).T
