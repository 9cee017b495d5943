"""What the links of a tree touch with: their shapes, grouped by surface; crests for wheels.

PyBullet knows one friction, and one pair of axes for it, for each body of its own.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import compress
from operator import not_
from typing import Any

from ...core import ALONG, UP, Pose, Vector, compose, conjugate, dot, rotate
from ...description import FIXED, REVOLUTE, Collision, Cylinder, JointSpec, LinkSpec, Plane
from .contact_stiffness import restitution
from .friction_axes import directions
from .generated_urdf import MeshFile, Tree
from .occluded_shapes import occluded_shapes
from .split_edge_contacts import split_edges

Groups = list[tuple[Collision, ...]]  # of a link: its own, then those of its auxiliary links

# Width of a wheel's crest [m]. PyBullet takes a margin of 1 mm off each end of a cylinder, so what
# is left of this one touches exactly in its middle.
_CREST = 0.002

# How much lower the shoulders of a wheel are, as a share of its half diagonal. What is nearer to
# the floor than 0.02 of that is a contact, which costs.
_CROWN = 0.022

# A shape above a plane costs 1.7 % of a step of the article's robot, an auxiliary link 5 %.
_WORTH_A_LINK = 6
_LEVEL = 5e-6  # [m] one side of a wheel may be so much lower, and both still touch a floor


def surface_groups(tree: Tree, i: int) -> Groups:
    """Return the collisions of link `i` by equal surface: first those of the link itself."""
    link, joint = tree.links[i], tree.joints[i]
    shapes = [shape for one in link.collisions for shape in crowned(one, link, joint)]
    return _by_surface(shapes) or [()]


def with_occluded_first(tree: Tree, groups: Groups, mesh_file: MeshFile) -> Groups | None:
    """Return the groups of a robot's root anew, first what no plane can touch: it is not checked.

    The rest is on auxiliary links. None if it is not worth it.
    """
    if not _drives(tree):
        return None
    first, *others = groups
    occluded = occluded_shapes(first, mesh_file) if first else ()
    if sum(occluded) < _WORTH_A_LINK:
        return None
    halves = [tuple(compress(first, half)) for half in (occluded, map(not_, occluded))]
    return [*halves, *others]


def with_split_edges(tree: Tree, groups: Groups) -> Groups:
    """Return the groups of a root anew: if it carries wheels, both ends of its edges can touch."""
    axle = _axle(tree) if _drives(tree) else None
    if axle is None:
        return groups
    up = rotate(conjugate(tree.links[0].pose.orientation), UP)
    return [split_edges(group, axle, up) for group in groups]


def is_floor(tree: Tree) -> bool:
    """Tell whether a tree is static and is planes and nothing else."""
    shapes = [collision.geometry for collision in tree.links[0].collisions]
    return tree.is_static and bool(shapes) and all(isinstance(shape, Plane) for shape in shapes)


def crowned(
    collision: Collision, link: LinkSpec, joint: JointSpec | None
) -> tuple[Collision, ...]:
    """Return what represents a collision: of a level wheel three narrow crests and lower shoulders.

    A cylinder touches a floor along a line, and PyBullet finds one end of it. The crests, at both
    ends and in the middle, share the load.
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
        *(replace(collision, geometry=rim, pose=compose(collision.pose, Pose((0.0, 0.0, z))))
          for z in ((-apart, 0.0, apart) if apart else (0.0,))),
        replace(collision, geometry=Cylinder(shoulders, wheel.length)),
    )


def wheel_shape(collision: Collision, joint: JointSpec | None) -> Cylinder | None:
    """Return the cylinder that a collision is if a joint turns it about its own axis, else None."""
    shape = collision.geometry
    if joint is None or joint.type != REVOLUTE or not isinstance(shape, Cylinder):
        return None
    along = abs(dot(rotate(collision.pose.orientation, UP), joint.axis_in_child)) >= ALONG
    return shape if along else None


def touching_end(wheel: Cylinder, axis: Vector) -> float:
    """Return how far from its middle, along `axis`, a lying cylinder touches a floor [m].

    One that leans does so with its lower end; one that is level with its crest, in the middle.
    """
    tilt = axis[2]
    if abs(tilt) * wheel.length <= _LEVEL:
        return 0.0
    return -math.copysign(wheel.length / 2.0, tilt)


def _drives(tree: Tree) -> bool:
    """Tell whether a tree can be a robot: its root moves, and so do links on it."""
    if tree.fixed_base or any(link.self_collide for link in tree.links):
        return False
    return any(joint is not None and joint.type != FIXED for joint in tree.joints)


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
    """Group by equal surface, since PyBullet knows one friction per body; first seen first."""
    groups: dict[tuple[Any, ...], list[Collision]] = {}
    for collision in collisions:
        surface = collision.surface
        key = (surface.kp, surface.kd, restitution(surface), directions(collision))
        groups.setdefault((surface.greatest_mu, *key), []).append(collision)
    return [tuple(group) for group in groups.values()]
