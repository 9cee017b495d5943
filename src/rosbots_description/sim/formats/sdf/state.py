"""The <state> of a saved world: poses of models and links; and the motion, if it is ours."""

from dataclasses import replace

from lxml import etree

from ...core import NANOSECONDS, Pose, Twist, as_quaternion, as_vector
from ...description import ModelState
from ..xml import limit_number, number, numbers
from .document import SdfDocument
from .exact import AXES, EFFORT, EXACT, TARGET, VELOCITY, is_unit
from .values import number_of, numbers_of, pose_in

_IDLE = ('wall_time', 'real_time', 'iterations', 'light')
_LINK_IDLE = ('velocity', 'acceleration', 'wrench')


def read_states(
    document: SdfDocument, element: etree._Element
) -> tuple[tuple[ModelState, ...], float]:
    """Return the states of the models in a <state>, and its simulated time [s].

    As in Gazebo only poses are applied, not velocities, unless this simulator wrote the state.

    Raises:
        ModelError: a pose, velocity or time is malformed.
    """
    exact = element.get(EXACT) is not None
    notes = document.notes
    notes.check(element, ('sim_time', 'model'), _IDLE)
    states = []
    for model in element.iterfind('model'):
        links: dict[str, Pose] = {}
        _read_model(document, model, '', links)
        pose = model.find('pose')
        placed = ModelState(model.get('name', ''), None if pose is None else pose_in(pose), links)
        states.append(_with_motion(placed, model) if exact else placed)
    return tuple(states), _sim_time(element)


def _read_model(
    document: SdfDocument, element: etree._Element, prefix: str, links: dict[str, Pose]
) -> None:
    document.notes.check(element, ('pose', 'link', 'model', 'scale'), ('joint',))
    scale = element.find('scale')
    if scale is not None and (scale.text or '').split() not in ([], ['1', '1', '1']):
        document.notes.warn(scale, 'the <scale> of a state is not applied; its poses are')
    for link in element.iterfind('link'):
        document.notes.check(link, ('pose',), _LINK_IDLE)
        if link.find('pose') is not None:
            links[prefix + link.get('name', '')] = pose_in(link.find('pose'))
    for inner in element.iterfind('model'):
        _read_model(document, inner, f'{prefix}{inner.get("name", "")}::', links)


def _with_motion(state: ModelState, model: etree._Element) -> ModelState:
    return replace(
        state,
        twists=_twists(model),
        joints=_joints(model),
        motors=_motors(model),
        axes=_axes(model),
    )


def _twists(model: etree._Element) -> dict[str, Twist]:
    found = {
        link.get('name', ''): numbers_of(link, 'velocity', (0.0,) * 6)
        for link in model.iterfind('link')
    }
    return {name: Twist(as_vector(six[:3]), as_vector(six[3:])) for name, six in found.items()}


def _joints(model: etree._Element) -> dict[str, tuple[float, float]]:
    return {
        joint.get('name', ''): (number_of(joint, 'angle', 0.0), number(joint, VELOCITY, 0.0))
        for joint in model.iterfind('joint')
    }


def _motors(model: etree._Element) -> dict[str, tuple[float, float]]:
    return {
        joint.get('name', ''): (number(joint, TARGET), limit_number(joint, EFFORT))
        for joint in model.iterfind('joint')
        if joint.get(TARGET) is not None
    }


def _axes(model: etree._Element) -> dict[str, Pose]:
    found = {}
    for link in model.iterfind('link'):
        if link.get(AXES) is not None:
            x, y, z, *turn = numbers(link, AXES, count=7)
            if is_unit(tuple(turn)):  # as it was written
                found[link.get('name', '')] = Pose((x, y, z), as_quaternion(turn))
    return found


def _sim_time(element: etree._Element) -> float:
    """Return <sim_time>seconds nanoseconds</sim_time> in seconds, at least 0."""
    parts = (element.findtext('sim_time') or '').split()
    if len(parts) != 2 or not all(part.isdecimal() for part in parts):
        return 0.0
    return int(parts[0]) + int(parts[1]) / NANOSECONDS
