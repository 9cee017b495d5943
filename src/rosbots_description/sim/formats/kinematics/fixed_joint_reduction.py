"""Reduce fixed joints: merge the links they connect, as sdformat 9 does (parser_urdf.cc).

The child's mass, shapes and joints go to its parent: the nearest ancestor that is not reduced
itself. Shapes get the names that Gazebo gives them:
`<parent>_fixed_joint_lump__<child>_collision`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from ...core import IDENTITY, Pose, compose, fault
from ...description import (
    WORLD,
    Collision,
    Element,
    Inertial,
    JointSpec,
    LinkSpec,
    SensorSpec,
    Visual,
)
from ...description.inertia import merge
from .frame_references import move_part, move_sensor
from .kinematic_tree import FREE, KinematicTree, LinkFlags

_LUMPED = '_fixed_joint_lump__'

Shape = TypeVar('Shape', Collision, Visual)


@dataclass(frozen=True)
class Reduction:
    """The result: links and joints that remain, and where the reduced ones went."""

    links: tuple[LinkSpec, ...]
    joints: tuple[JointSpec, ...]
    parents: Mapping[str, tuple[str, Pose]]  # of reduced links: name, and pose in it
    vanished: tuple[str, ...]  # links that are not simulated
    massless: tuple[str, ...]  # links without mass that are the cause
    conflicts: tuple[str, ...]  # reduced links whose flags changed their parent


def reduce_fixed_joints(tree: KinematicTree) -> Reduction:
    """Merge the links that fixed joints connect.

    A link without mass is not simulated, nor are its descendants below a joint that is not reduced;
    its own shapes are kept if it is reduced into a link with a mass.
    """
    order = tree.depth_first()
    homes = _homes(tree, order)
    vanished, massless = _massless(tree, order, homes)
    members: dict[str, list[str]] = {}
    for name in order:
        if name not in vanished and homes[name][0] != WORLD:
            members.setdefault(homes[name][0], []).append(name)
    poses = _poses_in_model(tree, order)
    kept = [name for name in order if name in members]
    joints = tuple(
        replace(joint.spec, parent=homes[joint.spec.parent][0])
        for joint in (tree.joint_to[name] for name in kept if name in tree.joint_to)
        if joint.spec.type != FREE
    )
    return Reduction(
        links=tuple(_merge_link(tree, name, members[name], homes, poses) for name in kept),
        joints=joints,
        parents={
            name: homes[name] for parent in kept for name in members[parent] if name != parent
        },
        vanished=tuple(name for name in order if name in vanished),
        massless=tuple(massless),
        conflicts=tuple(_conflicts(tree, members)),
    )


def _homes(tree: KinematicTree, order: Sequence[str]) -> dict[str, tuple[str, Pose]]:
    """Return for each link its parent after reduction (or itself) and its pose in that."""
    homes: dict[str, tuple[str, Pose]] = {}
    for name in order:
        joint = tree.joint_to.get(name)
        if joint is not None and tree.reduces(joint):
            parent, frame = homes[joint.spec.parent]
            homes[name] = (parent, compose(frame, joint.origin))
        else:
            homes[name] = (name, IDENTITY)
    return homes


def _massless(
    tree: KinematicTree, order: Sequence[str], homes: Mapping[str, tuple[str, Pose]]
) -> tuple[set[str], list[str]]:
    """Return the links that are not simulated, and those of them without mass, which are the cause.

    As in sdformat 9 a reduced link without mass, counting its own reduced children, also removes
    its descendants below joints that are not reduced.
    """
    mass = {name: _mass(tree.links[name].spec.inertial) for name in order}
    for name in reversed(order):
        joint = tree.joint_to.get(name)
        if joint is not None and tree.reduces(joint):
            mass[joint.spec.parent] += mass[name]
    cut_off: set[str] = set()  # links whose descendants are not simulated
    vanished: set[str] = set()
    causes: list[str] = []
    for name in order:
        if name == WORLD and name == tree.root:
            continue
        joint = tree.joint_to.get(name)
        above = joint.spec.parent if joint else None
        if above in cut_off or mass[name] == 0.0:
            cut_off.add(name)
        parent = homes[name][0]
        if parent in vanished or (parent == name and name in cut_off):
            vanished.add(name)
            if mass[name] == 0.0 and above not in vanished:
                causes.append(name)
            elif above is not None and above in cut_off and above not in vanished:
                causes.append(above)
    return vanished, list(dict.fromkeys(causes))


def _mass(inertial: Inertial | None) -> float:
    return 0.0 if inertial is None else inertial.mass


def _poses_in_model(tree: KinematicTree, order: Sequence[str]) -> dict[str, Pose]:
    poses: dict[str, Pose] = {}
    for name in order:
        joint = tree.joint_to.get(name)
        poses[name] = compose(poses[joint.spec.parent], joint.origin) if joint else IDENTITY
    return poses


def _merge_link(
    tree: KinematicTree,
    name: str,
    members: Sequence[str],
    homes: Mapping[str, tuple[str, Pose]],
    poses: Mapping[str, Pose],
) -> LinkSpec:
    collisions: list[Collision] = []
    visuals: list[Visual] = []
    sensors: list[SensorSpec] = []
    parts: list[Element] = []
    bodies: list[tuple[Pose, Inertial]] = []
    flags = LinkFlags()
    for member in members:
        link, frame = tree.links[member], homes[member][1]
        collisions += [_move(shape, frame, member) for shape in link.spec.collisions]
        visuals += [_move(shape, frame, member) for shape in link.spec.visuals]
        sensors += [move_sensor(sensor, frame, poses[name], poses) for sensor in link.spec.sensors]
        parts += [move_part(part, frame) for part in link.spec.parts]
        inertial = link.spec.inertial
        if inertial is not None and inertial.mass > 0.0:
            bodies.append((frame, inertial))
        flags.update(link.flags)
    return replace(
        tree.links[name].spec,
        pose=poses[name],
        inertial=merge(bodies),
        collisions=_named(collisions, name, '_collision'),
        visuals=_named(visuals, name, '_visual'),
        sensors=tuple(sensors),
        parts=tuple(parts),
        **flags,
    )


def _move(shape: Shape, frame: Pose, link: str) -> Shape:
    """Return the shape posed in the parent's frame, under its own name, else its link's."""
    return replace(shape, name=shape.name or link, pose=compose(frame, shape.pose))


def _named(shapes: Sequence[Shape], parent: str, suffix: str) -> tuple[Shape, ...]:
    """Return the shapes under Gazebo's names, numbered from the second shape of the link on.

    As in sdformat, a name that already begins with the parent's gets no prefix.
    """
    named = []
    for i, shape in enumerate(shapes):
        name = shape.name + suffix + (f'_{i}' if i else '')
        prefix = '' if name.startswith(parent) else parent + _LUMPED
        named.append(replace(shape, name=prefix + name))
    return tuple(named)


def _conflicts(tree: KinematicTree, members: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the reduced links whose flags change those of their parent."""
    return [
        member
        for parent, names in members.items()
        for member in names
        if member != parent
        and any(
            getattr(tree.links[parent].spec, key) != value
            for key, value in tree.links[member].flags.items()
        )
    ]


def require_links(tree: KinematicTree, reduction: Reduction) -> None:
    """Reject a model of which no link remains.

    Raises:
        ModelError: no link has a mass.
    """
    if reduction.links:
        return
    first = tree.links[next(iter(reduction.massless), tree.root)]
    if first.spec.name == WORLD:
        raise fault(first.element, 'the model has no link but the world; add a link with a mass')
    raise fault(
        first.element,
        'it has no mass, so no link of the model can be simulated; give it an <inertial> with '
        'a <mass> greater than zero and an <inertia>',
    )
