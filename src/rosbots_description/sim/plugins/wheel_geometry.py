"""What a wheel is: its radius, its axle, and how two of them carry a robot."""

from typing import TYPE_CHECKING

from ..core import UP, Vector, compose, cross, dot, rotate, subtract
from ..description import Cylinder, LinkSpec, Sphere

if TYPE_CHECKING:
    from ..runtime import Joint


def radius_of(joint: 'Joint') -> float | None:
    """Return the radius of a wheel [m]; None if it is not a single cylinder or ball."""
    collisions = _link(joint).collisions
    if len(collisions) != 1 or not isinstance(collisions[0].geometry, Cylinder | Sphere):
        return None
    return collisions[0].geometry.radius


def track_of(left: 'Joint', right: 'Joint') -> float:
    """Return the distance of two wheels along their axle [m]; below 0 if their sides are swapped.

    A wheel that turns forward drives across its axle, so its axle points to the left.
    """
    return dot(axle_of(left), subtract(_middle(left), _middle(right)))


def drives_towards_x(joint: 'Joint') -> bool:
    """Tell whether a wheel that turns forward drives the model towards its x axis, not away."""
    return cross(axle_of(joint), UP)[0] >= 0.0


def same_way(left: 'Joint', right: 'Joint') -> bool:
    """Tell whether both wheels drive the same way when they turn forward."""
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
