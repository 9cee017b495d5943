"""The camera of overview pictures."""

import math

from ..core import Pose, Vector, from_rpy
from .gl import Lens

EYE: Vector = (1.9, -1.9, 1.3)  # [m] for a view of a robot at the origin
TARGET: Vector = (0.0, 0.1, 0.25)  # [m]
OVERVIEW = Lens(640, 480, 1.01, 0.05, 100.0)


def look_at(eye: Vector, target: Vector) -> Pose:
    """Return the pose of a camera at `eye` [m, world] that looks at `target`, upright."""
    x, y, z = (end - begin for begin, end in zip(eye, target, strict=True))
    return Pose(eye, from_rpy(0.0, math.atan2(-z, math.hypot(x, y)), math.atan2(y, x)))
