"""What a wheel is: the radius of the shape that touches the ground, and the track of two."""

import math
from typing import TYPE_CHECKING

from .pose import compose, dot, rotate
from .spec import Cylinder, LinkSpec, Sphere

if TYPE_CHECKING:
    from .model import Joint


def radius_of(joint: 'Joint') -> float | None:
    """Return the radius of a wheel [m]; None if it is not a single cylinder or ball."""
    collisions = _link(joint).collisions
    if len(collisions) != 1 or not isinstance(collisions[0].geometry, Cylinder | Sphere):
        return None
    return collisions[0].geometry.radius


def track_of(left: 'Joint', right: 'Joint') -> float | None:
    """Return the distance of two wheels along their axle [m]; None if one has not one shape."""
    if radius_of(left) is None or radius_of(right) is None:
        return None
    link = _link(left)
    axle = rotate(link.pose.orientation, left.spec.axis_in_child)
    along = [dot(axle, _middle(_link(joint))) for joint in (left, right)]
    return math.dist(along[:1], along[1:])


def _middle(link: LinkSpec) -> tuple[float, float, float]:
    return compose(link.pose, link.collisions[0].pose).position


def _link(joint: 'Joint') -> LinkSpec:
    return joint.model.spec.link(joint.spec.child)
