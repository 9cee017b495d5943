"""Groups the collision shapes of a tree's links by surface; gives wheels a crowned profile.

A link of PyBullet has a single friction coefficient and a single set of friction axes.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from ...core import ALONG, UP, Pose, Vector, compose, conjugate, dot, rotate
from ...description import FIXED, REVOLUTE, Collision, Cylinder, JointSpec, LinkSpec, Plane
from .contact_stiffness import restitution
from .friction_axes import directions
from .generated_urdf import Tree
from .split_edge_contacts import split_edges

Groups = list[tuple[Collision, ...]]  # of a link: on itself, then on its auxiliary links

# Width of a wheel's crest [m]. PyBullet shrinks a cylinder by a margin of 1 mm at each end, so that
# this one touches exactly at its middle.
_CREST = 0.002

# Height of the crests above the shoulders, as a share of a wheel's half diagonal. Within 0.02 of
# that from the floor, PyBullet would generate needless contacts.
_CROWN = 0.022

_LEVEL = 5e-6  # [m] height difference of a wheel's ends below which both touch a floor


def surface_groups(tree: Tree, i: int) -> Groups:
    """Return the collisions of link `i` by surface; the first group is on the link itself."""
    link, joint = tree.links[i], tree.joints[i]
    shapes = [shape for one in link.collisions for shape in crowned(one, link, joint)]
    return _by_surface(shapes) or [()]


def with_split_edges(tree: Tree, groups: Groups) -> Groups:
    """Return the groups of a root; if it carries wheels, with split edge contacts."""
    axle = _axle(tree) if is_mobile(tree) else None
    if axle is None:
        return groups
    up = rotate(conjugate(tree.links[0].pose.orientation), UP)
    return [split_edges(group, axle, up) for group in groups]


def is_floor(tree: Tree) -> bool:
    """Tell whether a tree is static and consists of planes only."""
    shapes = [collision.geometry for collision in tree.links[0].collisions]
    return tree.is_static and bool(shapes) and all(isinstance(shape, Plane) for shape in shapes)


def is_mobile(tree: Tree) -> bool:
    """Tell whether a tree can be a mobile robot: its root is free and has movable joints."""
    if tree.fixed_base or any(link.self_collide for link in tree.links):
        return False
    return any(joint is not None and joint.type != FIXED for joint in tree.joints)


def crowned(collision: Collision, link: LinkSpec, joint: JointSpec | None) -> tuple[Collision, ...]:
    """Return the shapes of a collision: a level wheel gets a crowned profile, others stay.

    A cylinder touches a floor along a line, of which PyBullet finds one end. The crowned profile
    has three narrow crests, at both ends and in the middle, which share the load, and lower
    shoulders.
    """
    wheel = wheel_shape(collision, joint)
    if wheel is None:
        return (collision,)
    axis = rotate(collision.pose.orientation, UP)
    if touching_end(wheel, rotate(link.pose.orientation, axis)):
        return (collision,)
    reach = math.hypot(wheel.radius, wheel.radius, wheel.length / 2.0)
    shoulders = max(wheel.radius - _CROWN * reach, wheel.radius / 2.0)
    rim = Cylinder(wheel.radius, min(_CREST, wheel.length))
    apart = (wheel.length - rim.length) / 2.0
    return (
        *(
            replace(collision, geometry=rim, pose=compose(collision.pose, Pose((0.0, 0.0, z))))
            for z in ((-apart, 0.0, apart) if apart else (0.0,))
        ),
        replace(collision, geometry=Cylinder(shoulders, wheel.length)),
    )


def wheel_shape(collision: Collision, joint: JointSpec | None) -> Cylinder | None:
    """Return the cylinder of a collision that a joint rotates about its axis, else None."""
    shape = collision.geometry
    if joint is None or joint.type != REVOLUTE or not isinstance(shape, Cylinder):
        return None
    along = abs(dot(rotate(collision.pose.orientation, UP), joint.axis_in_child)) >= ALONG
    return shape if along else None


def touching_end(wheel: Cylinder, axis: Vector) -> float:
    """Return where a lying cylinder touches a floor: the offset from its middle along `axis` [m].

    A tilted wheel touches at its lower end, a level one at its middle.
    """
    tilt = axis[2]
    if abs(tilt) * wheel.length <= _LEVEL:
        return 0.0
    return -math.copysign(wheel.length / 2.0, tilt)


def _axle(tree: Tree) -> Vector | None:
    """Return the direction of the first wheel's axle in the frame of the root that carries it."""
    root = tree.links[0]
    for link, joint in zip(tree.links[1:], tree.joints[1:], strict=True):
        wheels = (len(crowned(one, link, joint)) > 1 for one in link.collisions)
        if joint and joint.parent == root.name and any(wheels):
            axle = rotate(link.pose.orientation, joint.axis_in_child)
            return rotate(conjugate(root.pose.orientation), axle)
    return None


def _by_surface(collisions: Sequence[Collision]) -> list[tuple[Collision, ...]]:
    """Group collisions by equal surface, in the order of their first member."""
    groups: dict[tuple[Any, ...], list[Collision]] = {}
    for collision in collisions:
        surface = collision.surface
        key = (
            surface.kp,
            surface.kd,
            restitution(surface),
            directions(collision),
            surface.collide_bitmask,
            surface.category_bitmask,
        )
        groups.setdefault((surface.greatest_mu, *key), []).append(collision)
    return [tuple(group) for group in groups.values()]
