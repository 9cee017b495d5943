"""Edges of a robot's body that touch a floor with both ends.

Of a box or a hull above a plane PyBullet finds one corner in a step, and of two that are equally
deep always the same. So a robot that falls on the front edge of its body, as one does that backs
at once, would take the blow with that corner, and turn. Two of the same shape in one place, each
tilted to one side by a hair, touch with a corner each.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

from ...core import Pose, Vector, compose, cross
from ...description import Box, Collision, Mesh

_TILT = 2e-4  # [rad]; half and five times as much do as well


def split_edges(shapes: Sequence[Collision], axle: Vector, up: Vector) -> tuple[Collision, ...]:
    """Return what represents the shapes of a robot's body: of each with edges two, tilted apart.

    Args:
        shapes: in the frame of the body, whose origin is not far from the middle of the axle.
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
