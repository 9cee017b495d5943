"""The <state> of a saved world: where models and links stood, and what joints that means."""

import math
from collections.abc import Mapping

from lxml import etree

from ...core import IDENTITY, Pose, compose, relative
from ...description import FIXED, PRISMATIC, JointSpec, ModelSpec, ModelState
from ...runtime import Model
from ..kinematics import WORLD
from .document import SdfDocument
from .values import pose_in

_NANOSECONDS = 1e9
_IDLE = ('wall_time', 'real_time', 'iterations', 'light')
_LINK_IDLE = ('velocity', 'acceleration', 'wrench')


def read_states(
    document: SdfDocument, element: etree._Element
) -> tuple[tuple[ModelState, ...], float]:
    """Return the states of the models in a <state>, and its simulated time [s].

    As in Gazebo velocities are not taken over, only places.

    Raises:
        ModelError: a pose or time is malformed.
    """
    notes = document.notes
    notes.check(element, ('sim_time', 'model'), _IDLE)
    states = []
    for model in element.iterfind('model'):
        links: dict[str, Pose] = {}
        _read_model(document, model, '', links)
        pose = model.find('pose')
        states.append(
            ModelState(model.get('name', ''), None if pose is None else pose_in(pose), links)
        )
    return tuple(states), _sim_time(element)


def _read_model(
    document: SdfDocument, element: etree._Element, prefix: str, links: dict[str, Pose]
) -> None:
    document.notes.check(element, ('pose', 'link', 'model', 'scale'), ('joint',))
    scale = element.find('scale')
    if scale is not None and (scale.text or '').split() not in ([], ['1', '1', '1']):
        document.notes.warn(scale, 'the <scale> of a state is not applied, only its poses')
    for link in element.iterfind('link'):
        document.notes.check(link, ('pose',), _LINK_IDLE)
        if link.find('pose') is not None:
            links[prefix + link.get('name', '')] = pose_in(link.find('pose'))
    for inner in element.iterfind('model'):
        _read_model(document, inner, f'{prefix}{inner.get("name", "")}::', links)


def _sim_time(element: etree._Element) -> float:
    """Return <sim_time>seconds nanoseconds</sim_time> in seconds, never before zero."""
    numbers = (element.findtext('sim_time') or '').split()
    if len(numbers) != 2 or not all(number.isdecimal() for number in numbers):
        return 0.0
    return int(numbers[0]) + int(numbers[1]) / _NANOSECONDS


def apply_state(model: Model, state: ModelState) -> None:
    """Bring a model to where a saved world had it, by its roots and its joints.

    The pose it resets to stays the one it was spawned at, as in Gazebo.
    """
    if state.pose is not None:
        model.set_pose(state.pose)
    roots = {name: state.links[name] for name in model.body.roots if name in state.links}
    if roots:
        model.engine.set_root_poses(model.body, roots)
    for name, position in joint_positions(model.spec, state).items():
        if name in model.joints:
            model.joints[name].set_position(position)


def joint_positions(spec: ModelSpec, state: ModelState) -> dict[str, float]:
    """Return the positions [rad or m] of the joints between links whose places are known."""
    placed: Mapping[str, Pose] = state.links
    if state.pose is not None:
        placed = {WORLD: state.pose, **state.links}
    zero = {WORLD: IDENTITY, **{link.name: link.pose for link in spec.links}}
    return {
        joint.name: _position(joint, zero, placed)
        for joint in spec.joints
        if joint.type != FIXED and joint.parent in placed and joint.child in placed
    }


def _position(joint: JointSpec, zero: Mapping[str, Pose], placed: Mapping[str, Pose]) -> float:
    """Return how far the joint's frame has moved along or about its axis since position zero."""
    at_zero = relative(compose(zero[joint.child], joint.pose), zero[joint.parent])
    now = relative(compose(placed[joint.child], joint.pose), placed[joint.parent])
    moved = relative(now, at_zero)
    axis = joint.axis
    if joint.type == PRISMATIC:
        return sum(a * b for a, b in zip(axis, moved.position, strict=True))
    x, y, z, w = moved.orientation
    half = math.atan2(axis[0] * x + axis[1] * y + axis[2] * z, w)
    return math.remainder(2.0 * half, 2.0 * math.pi)
