"""Split edge contacts: both ends of a body's edge touch a floor.

Between a box or hull and a plane PyBullet finds one corner per step, always the same of two that
are equally deep. A robot that pitches onto the front edge of its body, as in a sudden reversal,
would hit the floor with one corner and yaw. Two copies of the shape, tilted slightly to opposite
sides, touch with one corner each.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

from ...core import Pose, Vector, compose, cross
from ...description import Box, Collision, Mesh

_TILT = 2e-4  # [rad]; half and five times as much work, too


def split_edges(shapes: Sequence[Collision], axle: Vector, up: Vector) -> tuple[Collision, ...]:
    """Return the shapes of a robot's body, each box and mesh as two tilted copies.

    Args:
        shapes: in the frame of the body, whose origin is near the middle of the axle.
        axle, up: unit vectors in that frame.
    """
    x, y, z = cross(axle, up)
    found = []
    for shape in shapes:
        if not isinstance(shape.geometry, Box | Mesh):
            found.append(shape)
            continue
        for half in (_TILT / 2.0, -_TILT / 2.0):
            sine = math.sin(half)
            turn = (sine * x, sine * y, sine * z, math.cos(half))
            found.append(replace(shape, pose=compose(Pose(orientation=turn), shape.pose)))
    return tuple(found)
