"""Contact parts of a link in PyBullet: its groups of shapes, once for each role."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from ...core import Pose, compose, normalise
from ...description import Box, Collision, Plane
from .friction_pairs import Kind, Role, Side, coefficient, roles
from .generated_urdf import Tree
from .shape_groups import Groups, is_floor, is_mobile

# The box below a plane, 1000 km to each side [m]. With a larger one, contacts are less accurate.
_SLAB = Box((2e6, 2e6, 1e6))
# Its tilt [rad]. Bullet tests a shape of a compound only if its bounding box overlaps that of the
# slab. The tilt raises the latter by 5 cm above the face, so that contacts are found before bodies
# touch. The face is off by 0.05 mm at 1 km from the origin. The tilt is about y: about x, boxes
# parallel to the axes creep four times as fast.
_SLAB_TILT = 5e-8
# A robot's root with more shapes meets slabs: Bullet would test each of them against a plane.
_FEW_SHAPES = 6


class ContactPart(NamedTuple):
    """Shapes of equal surface, their collision filter, and their friction for PyBullet."""

    shapes: tuple[Collision, ...]
    side: Side
    friction: float


def contact_parts(tree: Tree, groups: Sequence[Groups], max_parts: int) -> list[list[ContactPart]]:
    """Return the contact parts of each link of a tree; the first one is on the link itself.

    Args:
        groups: of each link, from shape_groups.py.
        max_parts: limit for the tree. Above it each surface gets a single part, and the friction
            of a pair with both mu < 1 is mu1 * mu2 instead of min(mu1, mu2).
    """
    kinds = [_kind(tree, i) for i in range(len(groups))]
    found = [
        [part for group in of_link for part in _in_roles(group, kind, tree.is_static)]
        for kind, of_link in zip(kinds, groups, strict=True)
    ]
    if sum(map(len, found)) <= max_parts:
        return found
    return [[*{part.shapes: _in_both(part) for part in of_link}.values()] for of_link in found]


def slab(tree: Tree) -> list[ContactPart]:
    """Return the boxes that replace a floor of planes for bodies on slabs, for each role.

    Between a box and a plane PyBullet finds one corner per step, which would tip a box that lands
    flat. Between two boxes it finds four. And a box is bounded above: shapes high above it are
    skipped.
    """
    if not is_floor(tree):
        return []
    below = Pose((0.0, 0.0, -_SLAB.size[2] / 2.0))
    shapes = tuple(
        replace(one, geometry=_SLAB, pose=compose(compose(one.pose, _tilt(one.geometry)), below))
        for one in tree.links[0].collisions
        if isinstance(one.geometry, Plane)
    )
    return _in_roles(shapes, Kind.SLAB, is_static=True)


def _kind(tree: Tree, i: int) -> Kind:
    if is_floor(tree):
        return Kind.PLANE
    if tree.is_static:
        return Kind.STATIC
    shapes = [collision.geometry for collision in tree.links[i].collisions]
    if len(tree.links) == 1:
        on_slab = all(isinstance(shape, Box) for shape in shapes)
    else:
        on_slab = i == 0 and is_mobile(tree) and len(shapes) > _FEW_SHAPES
    return Kind.ON_SLAB if on_slab else Kind.MOVING


def _in_roles(group: tuple[Collision, ...], kind: Kind, is_static: bool) -> list[ContactPart]:
    mu = coefficient(group[0].surface.greatest_mu) if group else 1.0
    return [
        ContactPart(group, Side(kind, role, mu), mu if role is Role.OWN else 1.0)
        for role in roles(mu, is_static)
    ]


def _in_both(part: ContactPart) -> ContactPart:
    kind, _, mu = part.side
    return ContactPart(part.shapes, Side(kind, Role.BOTH, 1.0), min(1.0, mu))


def _tilt(plane: Plane) -> Pose:
    """Return the rotation of z onto the normal of a plane, and slightly beyond."""
    x, y, z = plane.normal
    onto = normalise((-y, x, 0.0, 1.0 + z)) if z > -1.0 else (1.0, 0.0, 0.0, 0.0)
    return compose(Pose(orientation=onto), Pose(orientation=(0.0, _SLAB_TILT / 2.0, 0.0, 1.0)))
