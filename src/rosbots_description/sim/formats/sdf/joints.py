"""Joints of SDF, and the trees that they form."""

from collections.abc import Sequence
from dataclasses import replace

from lxml import etree

from ...core import IDENTITY, Pose, Vector, compose, conjugate, fault, relative, rotate
from ...description import FIXED, PRISMATIC, REVOLUTE, WORLD, JointSpec, LinkSpec
from ..xml import required_name, scalar
from .document import SdfDocument
from .frames import MODEL_FRAME, Frames, is_posed_elsewhere
from .values import (
    boolean_of,
    limit_of,
    not_negative_of,
    number_of,
    numbers_of,
    pose_in,
    text_of,
    unit_vector_of,
)

_TYPES = {'revolute': REVOLUTE, 'continuous': REVOLUTE, 'prismatic': PRISMATIC, 'fixed': FIXED}
_NOT_SIMULATED = ('ball', 'universal', 'screw', 'revolute2', 'gearbox')
_DYNAMICS = ('damping', 'friction', 'spring_stiffness', 'spring_reference')
_UP = (0.0, 0.0, 1.0)
# Before SDF 1.5 axes are given in the model's frame; in 1.5 and 1.6 a flag selects it; since 1.7
# an attribute names the frame.
_AXIS_IN_JOINT, _AXIS_BY_NAME = (1, 5), (1, 7)


def add_joint_frame(frames: Frames, element: etree._Element) -> None:
    """Add a joint's frame, which is posed in the child's and attached to it."""
    carrier = text_of(element, 'child') or None
    frames.add(required_name(element), element, _child_frame(element), carrier)


def read_sdf_joint(
    document: SdfDocument, element: etree._Element, frames: Frames
) -> JointSpec | None:
    """Return the joint of a <joint>, or None if its type is not simulated, which is noted.

    Raises:
        ModelError: a name, type, link, frame or number is missing or wrong.
    """
    name = required_name(element)
    written = element.get('type', '')
    if written in _NOT_SIMULATED:
        document.notes.warn(
            element, f'{written} joints are not simulated; its two links are not connected'
        )
        return None
    if written not in _TYPES:
        raise fault(element, f"type '{written}' is unknown; there are {', '.join(_TYPES)}")
    document.notes.check(
        element, ('pose', 'parent', 'child', 'axis'), ('physics', 'provide_feedback')
    )
    kind = _TYPES[written]
    parent, child = _end(element, 'parent', frames), _end(element, 'child', frames)
    if parent == child:
        raise fault(element, f"it connects '{parent}' to itself; name two different links")
    if child == WORLD and kind != FIXED:
        raise fault(element, 'the world cannot be the child of a joint that moves; swap the two')
    if child == WORLD:  # a fixed joint may be reversed
        parent, child = child, parent
    frame = frames.place(element, base=_child_frame(element))
    spec = JointSpec(name, kind, parent, child, pose=_pose_in_child(element, child, frame, frames))
    if kind == FIXED:
        return spec
    return _with_motion(spec, document, element, written, frame, frames)


def _pose_in_child(element: etree._Element, child: str, frame: Pose, frames: Frames) -> Pose:
    """Return the pose of the joint's frame in its child, as it was written if that is in it."""
    pose = element.find('pose')
    if child == text_of(element, 'child') and not is_posed_elsewhere(pose):
        return pose_in(pose)
    return relative(frame, frames.pose_of(child, element))


def _child_frame(element: etree._Element) -> str:
    child = text_of(element, 'child')
    return '' if child == WORLD else child


def _end(element: etree._Element, role: str, frames: Frames) -> str:
    end = element.find(role)
    if end is None or not (name := scalar(end)):
        raise fault(element, f'it has no <{role}>; name a link')
    return WORLD if name == WORLD else frames.link_of(name, end)


def _with_motion(
    spec: JointSpec,
    document: SdfDocument,
    element: etree._Element,
    written: str,
    frame: Pose,
    frames: Frames,
) -> JointSpec:
    """Return the joint with its axis, limits and dynamics; `frame` is the joint's."""
    axis = element.find('axis')
    if axis is None:
        return replace(spec, axis=_UP)
    notes = document.notes
    notes.check(axis, ('xyz', 'limit', 'dynamics', 'use_parent_model_frame', 'initial_position'))
    spec = replace(spec, axis=_axis(document, axis, frame, frames))
    limit, dynamics = axis.find('limit'), axis.find('dynamics')
    if dynamics is not None:
        notes.check(dynamics, _DYNAMICS)
        spec = replace(
            spec,
            damping=not_negative_of(dynamics, 'damping', 0.0),
            friction=not_negative_of(dynamics, 'friction', 0.0),
            stiffness=not_negative_of(dynamics, 'spring_stiffness', 0.0),
            reference=number_of(dynamics, 'spring_reference', 0.0),
        )
    initial = axis.find('initial_position')
    if initial is not None:
        notes.unread(initial)
    if limit is None:
        return spec
    notes.check(limit, ('lower', 'upper', 'effort', 'velocity'), ('stiffness', 'dissipation'))
    effort, velocity = limit_of(limit, 'effort'), limit_of(limit, 'velocity')
    spec = replace(
        spec,
        effort=effort if effort is not None and effort >= 0.0 else None,
        velocity=velocity if velocity is not None and velocity >= 0.0 else None,
    )
    if written == 'continuous':
        return spec
    lower, upper = limit_of(limit, 'lower'), limit_of(limit, 'upper')
    if lower is not None and upper is not None and lower > upper:
        notes.warn(
            limit, f'lower limit {lower:g} is above upper limit {upper:g}; the two are swapped'
        )
        lower, upper = upper, lower
    return replace(spec, lower=lower, upper=upper)


def _axis(document: SdfDocument, axis: etree._Element, frame: Pose, frames: Frames) -> Vector:
    """Return the unit axis in the joint's frame."""
    if numbers_of(axis, 'xyz', _UP) == (0.0, 0.0, 0.0):
        document.notes.warn(axis, "<xyz> '0 0 0' has no direction; x is used, as in Gazebo")
        return (1.0, 0.0, 0.0)
    vector = unit_vector_of(axis, 'xyz', _UP)
    version = document.version
    if version >= _AXIS_BY_NAME:
        xyz = axis.find('xyz')
        if xyz is None or not (named := xyz.get('expressed_in')):
            return vector
        given_in = frames.pose_of(named, xyz)
    elif version < _AXIS_IN_JOINT or boolean_of(axis, 'use_parent_model_frame'):
        given_in = frames.pose_of(MODEL_FRAME, axis)
    else:
        return vector
    return rotate(conjugate(frame.orientation), rotate(given_in.orientation, vector))


def as_trees(
    document: SdfDocument,
    links: Sequence[LinkSpec],
    joints: Sequence[tuple[JointSpec, etree._Element]],
) -> tuple[JointSpec, ...]:
    """Return the joints such that every link is the child of at most one.

    SDF allows any graph of links. The engine works in joint coordinates, which need trees: a joint
    that closes a loop is left out and noted, and one that points towards the root is reversed
    together with its axis, so that its position keeps its sign.
    """
    group = {name: name for name in (WORLD, *(link.name for link in links))}

    def head(name: str) -> str:
        while group[name] != name:
            name = group[name] = group[group[name]]
        return name

    kept: list[JointSpec] = []
    for joint, element in joints:
        ends = head(joint.parent), head(joint.child)
        if ends[0] == ends[1]:
            document.notes.warn(
                element,
                f"it closes a kinematic loop, which is not simulated; '{joint.parent}' and "
                f"'{joint.child}' are not connected by it",
            )
            continue
        group[ends[1]] = ends[0]
        kept.append(joint)
    return _directed(links, kept)


def _directed(links: Sequence[LinkSpec], joints: Sequence[JointSpec]) -> tuple[JointSpec, ...]:
    """Return the joints, which form no loop, all pointing away from their tree's root."""
    poses = {link.name: link.pose for link in links}
    children = {joint.child for joint in joints}
    roots = [WORLD, *(name for name in poses if name not in children), *poses]
    at: dict[str, list[int]] = {}
    for i, joint in enumerate(joints):
        at.setdefault(joint.parent, []).append(i)
        at.setdefault(joint.child, []).append(i)
    directed = list(joints)
    reached: set[str] = set()
    for root in roots:
        waiting = [root]
        while waiting:
            name = waiting.pop()
            if name in reached:
                continue
            reached.add(name)
            for i in at.get(name, ()):
                if directed[i].child == name and directed[i].parent not in reached:
                    directed[i] = _reversed(directed[i], poses)
                waiting.append(directed[i].child)
    return tuple(directed)


def _reversed(joint: JointSpec, poses: dict[str, Pose]) -> JointSpec:
    frame = compose(poses[joint.child], joint.pose)
    x, y, z = joint.axis
    return replace(
        joint,
        parent=joint.child,
        child=joint.parent,
        pose=relative(frame, poses.get(joint.parent, IDENTITY)),
        axis=(-x, -y, -z),
    )
