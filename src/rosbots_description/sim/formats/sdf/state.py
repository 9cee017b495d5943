"""The <state> of a saved world: poses of models and links."""

from lxml import etree

from ...core import Pose
from ...description import ModelState
from .document import SdfDocument
from .values import pose_in

_NANOSECONDS = 1e9
_IDLE = ('wall_time', 'real_time', 'iterations', 'light')
_LINK_IDLE = ('velocity', 'acceleration', 'wrench')


def read_states(
    document: SdfDocument, element: etree._Element
) -> tuple[tuple[ModelState, ...], float]:
    """Return the states of the models in a <state>, and its simulated time [s].

    As in Gazebo only poses are applied, not velocities.

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
        document.notes.warn(scale, 'the <scale> of a state is not applied; its poses are')
    for link in element.iterfind('link'):
        document.notes.check(link, ('pose',), _LINK_IDLE)
        if link.find('pose') is not None:
            links[prefix + link.get('name', '')] = pose_in(link.find('pose'))
    for inner in element.iterfind('model'):
        _read_model(document, inner, f'{prefix}{inner.get("name", "")}::', links)


def _sim_time(element: etree._Element) -> float:
    """Return <sim_time>seconds nanoseconds</sim_time> in seconds, at least 0."""
    numbers = (element.findtext('sim_time') or '').split()
    if len(numbers) != 2 or not all(number.isdecimal() for number in numbers):
        return 0.0
    return int(numbers[0]) + int(numbers[1]) / _NANOSECONDS
