"""Rolling friction of parts, as PyBullet takes it."""

from collections.abc import Sequence

from ...description import Collision, Cylinder, JointSpec
from .shape_groups import wheel_shape

# Coefficient of rolling resistance of hard wheels on a hard floor. Half of it is enough to keep a
# can, a barrel and a robot on free wheels at rest.
_ROLLING_RESISTANCE = 0.005


def rolling_arm(collisions: Sequence[Collision], joint: JointSpec | None) -> float:
    """Return PyBullet's rolling friction of a part [m]: the lever arm of the normal force.

    Only cylinders need it. PyBullet updates one end of a lying cylinder's contact line per step;
    the contact at the other end lags behind the axis and would accelerate a can from rest. Wheels
    touch the floor at one point along the axle and do not need it (`crowned`, `touching_end`).

    Args:
        collisions: of the part, one or more.
    """
    radii = [one.geometry.radius for one in collisions if isinstance(one.geometry, Cylinder)]
    if len(radii) < len(collisions) or any(wheel_shape(one, joint) for one in collisions):
        return 0.0
    return _ROLLING_RESISTANCE * max(radii)
