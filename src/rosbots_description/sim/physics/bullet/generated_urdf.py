"""Generates plain URDF for PyBullet from the kinematic trees of a model.

PyBullet never reads a user's text. The generated URDF has one tag per line (PyBullet cuts lines at
8191 bytes), short generated names, explicit masses and clean mesh files. Inertia and visuals are
placeholders: PyBullet zeroes tensors that it finds implausible, so the engine sets the true one
after loading; and it makes visuals of the collisions of a link that has none.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple
from xml.sax.saxutils import quoteattr

from ...core import Pose, compose, inverse, relative, to_rpy
from ...description import (
    FIXED,
    PRISMATIC,
    Box,
    Collision,
    Cylinder,
    Geometry,
    JointSpec,
    LinkSpec,
    Mesh,
    ModelSpec,
    Plane,
    Sphere,
)

# Each further surface of a link is on an auxiliary link, fixed to it. PyBullet needs its mass to be
# above zero; it must be negligible beside that of a real link [kg].
AUXILIARY_MASS = 1e-9

# Placeholder visual. Without one PyBullet makes visuals of the collisions, which nobody sees: 9 MB
# for a plane, and for a mesh twice its memory and as much time as the mesh itself.
_PLACEHOLDER_VISUAL = ('<visual>', '<geometry>', '<box size="1 1 1"/>', '</geometry>', '</visual>')

# Collision group of moving bodies until their filter is set. In PyBullet's default, 1, the group of
# rays, they would collide with everything, which changes the solver's order of contacts for good.
_LOADED = 2

WORLD_LINK = LinkSpec('world')  # parent of models that are fixed to the world

MeshFile = Callable[[Mesh], str]  # a mesh -> the path of a clean file at the mesh's scale


class Tree(NamedTuple):
    """A kinematic tree, parents first; joints[i] is links[i]'s parent joint, None at the root."""

    links: list[LinkSpec]
    joints: list[JointSpec | None]
    fixed_base: bool  # the root never moves

    @property
    def is_static(self) -> bool:
        """Whether no link can move; meshes are then exact surfaces, else convex hulls."""
        return self.fixed_base and len(self.links) == 1


def describe_tree(
    tree: Tree,
    inertial_poses: Sequence[Pose],
    groups: Sequence[Sequence[Sequence[Collision]]],
    mesh_file: MeshFile,
) -> str:
    """Return the URDF of a tree; link i is called `l<i>`, its auxiliary links `l<i>a1` and so on.

    Args:
        tree: what to describe.
        inertial_poses: centre of mass and principal axes of each link, in the link's frame.
        groups: shapes on each link itself, then on each of its auxiliary links.
        mesh_file: returns the file of a mesh.
    """
    number = {link.name: i for i, link in enumerate(tree.links)}
    # PyBullet's link frame is the joint's frame; ours may differ.
    frames = [
        compose(link.pose, joint.pose) if joint else link.pose
        for link, joint in zip(tree.links, tree.joints, strict=True)
    ]
    lines = ['<robot name="m">']
    for i, (link, joint) in enumerate(zip(tree.links, tree.joints, strict=True)):
        is_fixed = tree.fixed_base and i == 0
        mass = link.inertial.mass if link.inertial and not is_fixed else 0.0
        back = inverse(joint.pose) if joint else Pose()
        inertial = compose(back, inertial_poses[i])
        lines += _link(f'l{i}', mass, inertial, back, groups[i][0], mesh_file)
        for k, group in enumerate(groups[i][1:], start=1):
            lines += _link(f'l{i}a{k}', AUXILIARY_MASS, Pose(), back, group, mesh_file)
            lines += _joint(f'j{i}a{k}', 'fixed', f'l{i}', f'l{i}a{k}', Pose(), ())
        if joint:
            parent = number[joint.parent]
            pose = relative(frames[i], frames[parent])
            lines += _joint(f'j{i}', _type(joint), f'l{parent}', f'l{i}', pose, _motion(joint))
    lines.append('</robot>')
    return '\n'.join(lines) + '\n'


def _link(
    name: str,
    mass: float,
    inertial: Pose,
    back: Pose,
    collisions: Sequence[Collision],
    mesh_file: MeshFile,
) -> list[str]:
    lines = [
        f'<link name="{name}">',
        '<inertial>',
        _origin(inertial),
        f'<mass value="{mass!r}"/>',
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>',
        '</inertial>',
        *(_PLACEHOLDER_VISUAL if collisions else ()),
    ]
    for collision in collisions:
        # Exact surfaces only if static: moving concave meshes are slow and can be penetrated.
        concave = ' concave="yes"' if mass == 0.0 and isinstance(collision.geometry, Mesh) else ''
        group = f' group="{_LOADED}"' if mass else ''
        lines += [
            f'<collision{group}{concave}>',
            _origin(compose(back, collision.pose)),
            '<geometry>',
        ]
        lines += [_geometry(collision.geometry, mesh_file), '</geometry>', '</collision>']
    lines.append('</link>')
    return lines


def _geometry(geometry: Geometry, mesh_file: MeshFile) -> str:
    match geometry:
        case Box(size):
            return f'<box size="{_numbers(size)}"/>'
        case Sphere(radius):
            return f'<sphere radius="{radius!r}"/>'
        case Cylinder(radius, length):
            return f'<cylinder radius="{radius!r}" length="{length!r}"/>'
        case Plane(normal):
            return f'<plane normal="{_numbers(normal)}"/>'
        case Mesh():
            # the name of the temporary folder may need escapes
            return f'<mesh filename={quoteattr(mesh_file(geometry))}/>'


def _joint(
    name: str, kind: str, parent: str, child: str, pose: Pose, motion: Sequence[str]
) -> list[str]:
    return [
        f'<joint name="{name}" type="{kind}">',
        f'<parent link="{parent}"/>',
        f'<child link="{child}"/>',
        _origin(pose),
        *motion,
        '</joint>',
    ]


def _type(joint: JointSpec) -> str:
    if joint.type in (FIXED, PRISMATIC):
        return joint.type
    return 'continuous' if joint.lower is None and joint.upper is None else 'revolute'


def _motion(joint: JointSpec) -> list[str]:
    if joint.type == FIXED:
        return []
    # PyBullet takes an empty range for no limit, so upper must exceed lower slightly.
    lower = -1e9 if joint.lower is None else joint.lower
    upper = 1e9 if joint.upper is None else max(joint.upper, lower + 1e-6)
    return [
        f'<axis xyz="{_numbers(joint.axis)}"/>',
        f'<limit lower="{lower!r}" upper="{upper!r}" effort="0" velocity="0"/>',
    ]


def _origin(pose: Pose) -> str:
    return f'<origin xyz="{_numbers(pose.position)}" rpy="{_numbers(to_rpy(pose.orientation))}"/>'


def _numbers(values: Sequence[float]) -> str:
    return ' '.join(repr(float(value)) for value in values)


def kinematic_trees(spec: ModelSpec) -> list[Tree]:
    """Return the kinematic trees of a model.

    Each link of a static model is a tree of its own. A root that a movable joint connects to the
    world gets an empty fixed link as parent.
    """
    if spec.static:
        return [Tree([link], [None], True) for link in spec.links]
    above = {joint.child: joint for joint in spec.joints}
    below: dict[str, list[LinkSpec]] = {}
    trees = []
    for link in spec.links:
        joint = above.get(link.name)
        if joint is None:
            trees.append(Tree([link], [None], link.kinematic))
        elif joint.parent != WORLD_LINK.name:
            below.setdefault(joint.parent, []).append(link)
        elif joint.type == FIXED:
            trees.append(Tree([link], [None], True))
        else:
            # A name of its own, as a model may have several of them.
            anchor = replace(WORLD_LINK, name=f'world of {link.name}')
            joint = replace(joint, parent=anchor.name)
            trees.append(Tree([anchor, link], [None, joint], True))
    for tree in trees:
        for link in tree.links:  # the list grows during the loop
            children = below.get(link.name, ())
            tree.links.extend(children)
            tree.joints.extend(above[child.name] for child in children)
    return trees


def filtered_links(spec: ModelSpec) -> Iterator[tuple[str, str]]:
    """Yield each pair of links of a model that do not collide.

    Two links collide only if both have <self_collide> and no joint connects them.
    """
    joined = {frozenset((joint.parent, joint.child)) for joint in spec.joints}
    for a, b in combinations(spec.links, 2):
        if not (a.self_collide and b.self_collide) or {a.name, b.name} in joined:
            yield a.name, b.name
