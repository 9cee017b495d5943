"""Say in PyBullet's terms what a model is: its trees as plain URDF.

PyBullet never sees a user's text. What it gets has one tag per line (it cuts lines at 8191
bytes), short names of ours, explicit masses and clean mesh files. Inertia and visuals are only
placeholders here: PyBullet zeroes tensors it finds impossible, so the engine sets the true one
afterwards, and would draw what it is given no visual of.
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

# Each further surface of a link is an auxiliary link, fixed to it. Its mass must not be zero for
# PyBullet, and must not matter beside that of any real link [kg].
AUXILIARY_MASS = 1e-9

# Of a link without visual PyBullet makes pictures of the collisions, which nobody sees: of a plane
# a chequered one of 9 MB, of a mesh one that takes as long and twice as much memory as the mesh.
_UNSEEN = ('<visual>', '<geometry>', '<box size="1 1 1"/>', '</geometry>', '</visual>')

# Group of what moves until it has its collision filter. In PyBullet's own, 1, that of rays,
# it would meet all that can be seen, and the solver would take contacts in another order for good.
_LOADED = 2

WORLD_LINK = LinkSpec('world')  # what models are fixed to

MeshFile = Callable[[Mesh], str]  # a mesh -> the path of a clean file at the mesh's scale


class Tree(NamedTuple):
    """Links that joints connect, parents first; joints[i] is above links[i], None at the root."""

    links: list[LinkSpec]
    joints: list[JointSpec | None]
    fixed_base: bool  # the root never moves

    @property
    def is_static(self) -> bool:
        """Whether nothing in it moves; its meshes are then exact surfaces, else convex hulls."""
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
        groups: what each link touches with itself, then what each of its auxiliary links does.
        mesh_file: gives the file of a mesh.
    """
    number = {link.name: i for i, link in enumerate(tree.links)}
    # PyBullet's link frame is the joint's frame, ours may stand elsewhere.
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
        *(_UNSEEN if collisions else ()),
    ]
    for collision in collisions:
        # Exact surfaces only where nothing moves: a concave mesh in motion is slow and leaky.
        concave = ' concave="yes"' if mass == 0.0 and isinstance(collision.geometry, Mesh) else ''
        group = f' group="{_LOADED}"' if mass else ''
        lines += [f'<collision{group}{concave}>', _origin(compose(back, collision.pose)),
                  '<geometry>']
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
            # the folder for temporary files may be called anything
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
    # An empty range means no limit to PyBullet, so a joint limited to one point keeps a hair.
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
    """Return the trees that a model consists of.

    In a static model nothing moves, so there every link is a tree of its own. A root that a
    movable joint connects to the world hangs on an empty link that does not move.
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
            # Its name must differ from that of other doors of the same house.
            anchor = replace(WORLD_LINK, name=f'world of {link.name}')
            joint = replace(joint, parent=anchor.name)
            trees.append(Tree([anchor, link], [None, joint], True))
    for tree in trees:
        for link in tree.links:  # it grows while we walk it
            children = below.get(link.name, ())
            tree.links.extend(children)
            tree.joints.extend(above[child.name] for child in children)
    return trees


def filtered_links(spec: ModelSpec) -> Iterator[tuple[str, str]]:
    """Yield each pair of links that pass through each other.

    Two links of a model touch only if both ask for it and no joint connects them.
    """
    joined = {frozenset((joint.parent, joint.child)) for joint in spec.joints}
    for a, b in combinations(spec.links, 2):
        if not (a.self_collide and b.self_collide) or {a.name, b.name} in joined:
            yield a.name, b.name
