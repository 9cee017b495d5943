"""Boxes whose edges touch a floor with both ends.

Of a box above a plane PyBullet finds one corner in a step, and of two that are equally deep always
the same. So a robot that falls on the front edge of its body, as one does that backs off at once,
would take the blow with that corner, and turn. Two halves that lean outwards by a hair touch with
the outer corner each.
"""

import math
from dataclasses import replace

from .pose import ALONG, ZERO, Pose, Vector, add, compose, conjugate, cross, rotate
from .spec import Box, Collision

_LEAN = 2e-4  # [rad] more than a robot that drives straight on rolls by as it falls
_AXES: tuple[Vector, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def halves(collision: Collision, axle: Vector, up: Vector) -> tuple[Collision, ...]:
    """Return what stands for a collision of a robot's body: of a box along its axle two halves.

    Args:
        collision: a shape of the body.
        axle, up: unit vectors in the frame of the body.
    """
    box = collision.geometry
    if not isinstance(box, Box):
        return (collision,)
    turn = collision.pose.orientation
    across = rotate(conjugate(turn), axle)
    k = max(range(3), key=lambda i: abs(across[i]))
    if abs(across[k]) < ALONG:
        return (collision,)
    size = replace(box, size=tuple(s / 2.0 if i == k else s for i, s in enumerate(box.size)))
    found = []
    for side in (1.0, -1.0):
        outwards = rotate(turn, tuple(side * x for x in _AXES[k]))
        lean = tuple(math.sin(_LEAN / 2.0) * x for x in cross(up, outwards))
        place = tuple(box.size[k] / 4.0 * x for x in outwards)
        half = Pose(add(collision.pose.position, place), (*lean, math.cos(_LEAN / 2.0)))
        found.append(replace(collision, geometry=size, pose=compose(half, Pose(ZERO, turn))))
    return tuple(found)
