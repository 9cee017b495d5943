"""Contact parts of a link in PyBullet: its groups of shapes, once for each role."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from ...core import Pose, compose, normalise
from ...description import Box, Collision, Plane
from .friction_pairs import Kind, Role, Side, coefficient, roles
from .generated_urdf import Tree
from .shape_groups import Groups, is_floor

# The box below a plane, 1000 km to each side [m].
_SLAB = Box((2e6, 2e6, 1e6))


class ContactPart(NamedTuple):
    """Shapes of equal surface, their collision filter, and their friction for PyBullet."""

    shapes: tuple[Collision, ...]
    side: Side
    friction: float


def contact_parts(
    tree: Tree, groups: Sequence[Groups], occluded_first: bool, max_parts: int
) -> list[list[ContactPart]]:
    """Return the contact parts of each link of a tree; the first one is on the link itself.

    Args:
        groups: of each link, from shape_groups.py.
        occluded_first: whether the first group of the root is occluded by the others.
        max_parts: limit for the tree. Above it each surface gets a single part, and the friction
            of a pair with both mu < 1 is mu1 * mu2 instead of min(mu1, mu2).
    """
    kind = _kind(tree)
    found = []
    for i, of_link in enumerate(groups):
        kinds = [Kind.OCCLUDED if occluded_first and not i and not k else kind
                 for k in range(len(of_link))]
        found.append([part for group, one in zip(of_link, kinds, strict=True)
                      for part in _in_roles(group, one, tree.is_static)])
    if sum(map(len, found)) <= max_parts:
        return found
    return [[*{part.shapes: _in_both(part) for part in of_link}.values()] for of_link in found]


def slab(tree: Tree) -> list[ContactPart]:
    """Return the boxes that replace a floor of planes in contacts with boxes, for each role.

    Between a box and a plane PyBullet finds one corner per step, which would tip a box that lands
    flat. Between two boxes it finds four.
    """
    if not is_floor(tree):
        return []
    below = Pose((0.0, 0.0, -_SLAB.size[2] / 2.0))
    shapes = tuple(
        replace(one, geometry=_SLAB, pose=compose(compose(one.pose, _tilt(one.geometry)), below))
        for one in tree.links[0].collisions if isinstance(one.geometry, Plane)
    )
    return _in_roles(shapes, Kind.SLAB, is_static=True)


def _kind(tree: Tree) -> Kind:
    if is_floor(tree):
        return Kind.PLANE
    if tree.is_static:
        return Kind.STATIC
    shapes = [collision.geometry for link in tree.links for collision in link.collisions]
    only_boxes = len(tree.links) == 1 and all(isinstance(shape, Box) for shape in shapes)
    return Kind.BOXES if only_boxes else Kind.MOVING


def _in_roles(group: tuple[Collision, ...], kind: Kind, is_static: bool) -> list[ContactPart]:
    mu = coefficient(group[0].surface.greatest_mu) if group else 1.0
    return [ContactPart(group, Side(kind, role, mu), mu if role is Role.OWN else 1.0)
            for role in roles(mu, is_static)]


def _in_both(part: ContactPart) -> ContactPart:
    kind, _, mu = part.side
    return ContactPart(part.shapes, Side(kind, Role.BOTH, 1.0), min(1.0, mu))


def _tilt(plane: Plane) -> Pose:
    """Return the rotation of z onto the normal of a plane."""
    x, y, z = plane.normal
    return Pose(orientation=normalise((-y, x, 0.0, 1.0 + z)) if z > -1.0 else (1.0, 0.0, 0.0, 0.0))
