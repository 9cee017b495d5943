"""Say in PyBullet's terms what a model is: its trees as plain URDF, its surfaces as friction.

PyBullet never sees a user's text. What it gets has one tag per line (it cuts lines at 8191
bytes), short names of ours, explicit masses and clean mesh files. Inertia and visuals are only
placeholders here: PyBullet zeroes tensors it finds impossible, so the engine sets the true one
afterwards, and would draw what it is given no visual of.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple
from xml.sax.saxutils import quoteattr

from .inertia import principal_axes
from .pose import Pose, compose, dot, inverse, relative, rotate, to_rpy
from .spec import (
    FIXED,
    PRISMATIC,
    REVOLUTE,
    Box,
    Collision,
    Cylinder,
    Geometry,
    Inertial,
    JointSpec,
    LinkSpec,
    Mesh,
    ModelSpec,
    Plane,
    Sphere,
    Surface,
)

# A part of a link that touches differently rides on the link as a body of its own; its mass must
# not be zero for PyBullet and must not matter beside any real link [kg].
RIDER_MASS = 1e-9

_STIFFEST = 1e12  # [N/m] the stiffness that SDF gives to contacts nobody described

ALONG = 0.999  # cosine of the angle to an axis, from which on a direction is that axis

# Share of the weight that holds back what rolls, as with hard wheels on a hard floor; half of it is
# enough to keep a can, a barrel and a robot on free wheels in their place.
_ROLLING_RESISTANCE = 0.005

# Of a wheel, as shares of its half diagonal: width of the crest, and how much lower the shoulders
# are. Points that are nearer to each other than 0.02 of it are one contact to PyBullet, and what is
# nearer to the floor than that is a contact, which costs.
_CREST, _CROWN = 0.01, 0.022
_SINKS_IN = 5e-5  # [m] one side of a wheel may be so much lower, and both still touch the floor

# Of a link without visual PyBullet makes pictures of the collisions, which nobody sees: of a plane
# a chequered one of 9 MB, of a mesh one that takes as long and twice as much memory as the mesh.
_UNSEEN = ('<visual>', '<geometry>', '<box size="1 1 1"/>', '</geometry>', '</visual>')

WORLD_LINK = LinkSpec('world')  # what models are bolted to

MeshFile = Callable[[Mesh], str]  # a mesh -> the path of a clean file at the mesh's scale


class Tree(NamedTuple):
    """Links that joints connect, parents first; joints[i] is above links[i], None at the root."""

    links: list[LinkSpec]
    joints: list[JointSpec | None]
    fixed_base: bool  # the root never moves

    @property
    def stands(self) -> bool:
        """Whether nothing in it moves; its meshes are then exact surfaces, else convex hulls."""
        return self.fixed_base and len(self.links) == 1


def describe_tree(tree: Tree, inertial_poses: Sequence[Pose], mesh_file: MeshFile) -> str:
    """Return the URDF of a tree; link i is called `l<i>`.

    Args:
        tree: what to describe.
        inertial_poses: centre of mass and principal axes of each link, in the link's frame.
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
        mass = 0.0 if tree.fixed_base and i == 0 else link.inertial.mass
        back = inverse(joint.pose) if joint else Pose()
        groups = surface_groups(tree, i)
        inertial = compose(back, inertial_poses[i])
        lines += _link(f'l{i}', mass, inertial, back, groups[0], mesh_file)
        for k, group in enumerate(groups[1:], start=1):
            lines += _link(f'l{i}r{k}', RIDER_MASS, Pose(), back, group, mesh_file)
            lines += _joint(f'j{i}r{k}', 'fixed', f'l{i}', f'l{i}r{k}', Pose(), ())
        if joint:
            parent = number[joint.parent]
            pose = relative(frames[i], frames[parent])
            lines += _joint(f'j{i}', _type(joint), f'l{parent}', f'l{i}', pose, _motion(joint))
    lines.append('</robot>')
    return '\n'.join(lines) + '\n'


def surface_groups(tree: Tree, i: int) -> list[tuple[Collision, ...]]:
    """Return the collisions of link `i` by equal surface: first the link's own, then the riders'.

    PyBullet takes the axes of the inertia for a body's own. Where those of a robot's root are
    askew, all of its collisions ride, with the axes of the link: what a robot drags over the ground
    has to hold sideways and ahead differently (dragging.py).
    """
    link, joint = tree.links[i], tree.joints[i]
    groups = _by_surface([shape for one in link.collisions for shape in crowned(one, link, joint)])
    if groups and i == 0 and _drives(tree) and _is_askew(tree.links[0].inertial):
        return [(), *groups]
    return groups or [()]


def is_one_body(tree: Tree) -> bool:
    """Tell whether a tree is to be a rigid body of PyBullet's, and not a multibody.

    What stands is: in a contact with a multibody, even one without joints, PyBullet solves for six
    unknowns more. A step of the article's robot is 12 % cheaper on a floor that is a rigid body.
    """
    return tree.stands and len(surface_groups(tree, 0)) == 1


def crowned(
    collision: Collision, link: LinkSpec, joint: JointSpec | None
) -> tuple[Collision, ...]:
    """Return what stands for a collision: of a level wheel a narrow crest and lower shoulders.

    A cylinder touches a floor along a line, and PyBullet puts all of the force on one end of it. As
    that is the same end for the left and the right wheel, what they push with would turn a robot.
    """
    wheel = collision.geometry
    if joint is None or joint.type != REVOLUTE or not isinstance(wheel, Cylinder):
        return (collision,)
    axis = rotate(collision.pose.orientation, (0.0, 0.0, 1.0))
    axle = rotate(joint.pose.orientation, joint.axis)
    tilt = rotate(link.pose.orientation, axis)[2]
    if abs(dot(axis, axle)) < ALONG or abs(tilt) * wheel.length > _SINKS_IN:
        return (collision,)
    reach = math.hypot(wheel.radius, wheel.radius, wheel.length / 2.0)
    shoulders = max(wheel.radius - _CROWN * reach, wheel.radius / 2.0)
    return (
        replace(collision, geometry=Cylinder(wheel.radius, min(_CREST * reach, wheel.length))),
        replace(collision, geometry=Cylinder(shoulders, wheel.length)),
    )


def _drives(tree: Tree) -> bool:
    """Tell whether a tree can be a robot: its root moves, and so do links on it."""
    if tree.fixed_base or any(link.self_collide for link in tree.links):
        return False
    return any(joint is not None and joint.type != FIXED for joint in tree.joints)


def _is_askew(inertial: Inertial) -> bool:
    """Tell whether the principal axes are none of the link's."""
    _, turn = principal_axes(inertial)
    axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    return any(max(map(abs, rotate(turn, axis))) < ALONG for axis in axes)


def _by_surface(collisions: Sequence[Collision]) -> list[tuple[Collision, ...]]:
    """Group by equal surface, since PyBullet knows one friction per body; first seen first."""
    groups: dict = {}
    for collision in collisions:
        surface = collision.surface
        groups.setdefault((surface.mu, surface.kp, surface.kd), []).append(collision)
    return [tuple(group) for group in groups.values()]


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
        lines += [f'<collision{concave}>', _origin(compose(back, collision.pose)), '<geometry>']
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


def friction(surface: Surface) -> float:
    """Return the friction PyBullet is to use for a surface.

    Gazebo's engine lets a pair slide at the lesser mu, PyBullet at the product. A surface with
    mu >= 1 gets 1, so that against it the other's own mu counts, as in Gazebo; only a pair of two
    slippery surfaces (both below 1) slides more easily here.
    """
    return min(1.0, max(0.0, surface.mu))


def rolling_arm(collisions: Sequence[Collision]) -> float:
    """Return PyBullet's rolling friction of a body [m]: how far before the axle the ground pushes.

    Only cylinders need it. One that lies has an edge at each end, and PyBullet finds but one of
    them in a step; the other pushes from where it was, from behind, and a can at rest would roll
    away faster and faster.
    """
    shapes = [collision.geometry for collision in collisions]
    if not all(isinstance(shape, Cylinder) for shape in shapes):
        return 0.0
    return _ROLLING_RESISTANCE * max((shape.radius for shape in shapes), default=0.0)


def overlap_share(step_size: float, push_out: float) -> float:
    """Return the share of an overlap that contacts take away in a step.

    Args:
        step_size: duration of the step [s].
        push_out: rate at which bodies are pushed apart [1/s].
    """
    return min(0.2, push_out * step_size)


def contact_spring(
    surface: Surface, step_size: float, push_out: float
) -> tuple[float, float] | None:
    """Return stiffness [N/m] and damping [N s/m] of a contact; None if nobody described it.

    It gives way by force / kp at rest, and is damped so much that it parts bodies no faster than
    other contacts do; a kd of a user's could shoot them away. Arguments as in `overlap_share`.
    """
    if surface.kp >= _STIFFEST:
        return None
    least = step_size * surface.kp * (1.0 / overlap_share(step_size, push_out) - 1.0)
    return surface.kp, max(surface.kd, least)


def kinematic_trees(spec: ModelSpec) -> list[Tree]:
    """Return the trees that a model consists of.

    In a static model nothing moves, so there every link is a tree of its own. A root that a
    movable joint connects to the world hangs on an empty link that stands still.
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


def mesh_needs(spec: ModelSpec) -> Iterator[tuple[Mesh, bool]]:
    """Yield each mesh that can be touched, and whether its exact surface is used, not its hull."""
    for tree in kinematic_trees(spec):
        for link in tree.links:
            for collision in link.collisions:
                if isinstance(collision.geometry, Mesh):
                    yield collision.geometry, tree.stands


def untouching_links(spec: ModelSpec) -> Iterator[tuple[str, str]]:
    """Yield each pair of links that pass through each other.

    Two links of a model touch only if both ask for it and no joint connects them.
    """
    joined = {frozenset((joint.parent, joint.child)) for joint in spec.joints}
    for a, b in combinations(spec.links, 2):
        if not (a.self_collide and b.self_collide) or {a.name, b.name} in joined:
            yield a.name, b.name
