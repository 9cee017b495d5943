"""Geometry of wheels: radius, axle, track."""

from typing import TYPE_CHECKING

from ..core import UP, Vector, compose, cross, dot, rotate, subtract
from ..description import Cylinder, LinkSpec, Sphere

if TYPE_CHECKING:
    from ..runtime import Joint


def radius_of(joint: 'Joint') -> float | None:
    """Return the radius of a wheel [m]; None if it is not a single cylinder or sphere."""
    collisions = _link(joint).collisions
    if len(collisions) != 1 or not isinstance(collisions[0].geometry, Cylinder | Sphere):
        return None
    return collisions[0].geometry.radius


def track_of(left: 'Joint', right: 'Joint') -> float:
    """Return the distance of two wheels along their axle [m]; negative if they are swapped.

    The axle of a wheel that turns forward points to the left.
    """
    return dot(axle_of(left), subtract(_middle(left), _middle(right)))


def drives_towards_x(joint: 'Joint') -> bool:
    """Tell whether positive rotation of a wheel drives the model towards +x."""
    return cross(axle_of(joint), UP)[0] >= 0.0


def same_direction(left: 'Joint', right: 'Joint') -> bool:
    """Tell whether positive rotation of both wheels drives in the same direction."""
    return dot(axle_of(left), axle_of(right)) > 0.0


def axle_of(joint: 'Joint') -> Vector:
    """Return the direction of a wheel's axis in the frame of the model as it was spawned."""
    return rotate(_link(joint).pose.orientation, joint.spec.axis_in_child)


def _middle(joint: 'Joint') -> Vector:
    link = _link(joint)
    if not link.collisions:
        return link.pose.position
    return compose(link.pose, link.collisions[0].pose).position


def _link(joint: 'Joint') -> LinkSpec:
    return joint.model.links[joint.spec.child].spec
