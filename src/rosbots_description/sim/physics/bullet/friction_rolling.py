"""How hard it is to roll, in PyBullet's terms."""

from collections.abc import Sequence

from ...description import Collision, Cylinder, JointSpec
from .shape_groups import wheel_shape

# Share of the weight that holds back what rolls, as with hard wheels on a hard floor; half of it is
# enough to keep a can, a barrel and a robot on free wheels in their place.
_ROLLING_RESISTANCE = 0.005


def rolling_arm(collisions: Sequence[Collision], joint: JointSpec | None) -> float:
    """Return PyBullet's rolling friction of a body [m]: how far before the axle the ground pushes.

    Only cylinders need it. One that lies has an edge at each end, and PyBullet finds but one of
    them in a step; the other pushes from where it was, from behind, and a can at rest would roll
    away faster and faster. Wheels do not: they touch in one place (`crowned`, `touching_end`).
    """
    radii = [one.geometry.radius for one in collisions if isinstance(one.geometry, Cylinder)]
    if len(radii) < len(collisions) or any(wheel_shape(one, joint) for one in collisions):
        return 0.0
    return _ROLLING_RESISTANCE * max(radii, default=0.0)
