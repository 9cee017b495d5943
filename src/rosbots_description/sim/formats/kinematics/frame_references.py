"""Follow reduced links in sensor and plugin blocks: what named the child now names its parent."""

from collections.abc import Mapping
from dataclasses import replace

from ...core import IDENTITY, Pose, compose, from_rpy, to_rpy
from ...description import Element, PluginSpec
from ..xml import parse_numbers

_ZERO = (0.0, 0.0, 0.0)


def move_part(element: Element, frame: Pose) -> Element:
    """Return a sensor, light or projector of a reduced link with its <pose> in the parent's frame.

    A pose with `relative_to` keeps its meaning and so its text.

    Args:
        frame: where the reduced link stands in its parent.
    """
    old = element.child('pose')
    if frame == IDENTITY or (old is not None and 'relative_to' in old.attributes):
        return element
    numbers = parse_numbers(old.text, 6) if old is not None else None
    own = Pose(numbers[:3], from_rpy(*numbers[3:])) if numbers else IDENTITY
    pose = compose(frame, own)
    text = _text((*pose.position, *to_rpy(pose.orientation)))
    moved = replace(old or Element('pose', line=element.line), text=text)
    others = tuple(child for child in element.children if child is not old)
    return replace(element, children=(moved, *others))


def repoint_plugin(plugin: PluginSpec, parents: Mapping[str, tuple[str, Pose]]) -> PluginSpec:
    """Return the plugin with its <bodyName> and <frameName> naming links that are still there.

    <xyzOffset> [m] and <rpyOffset> [rad] then say where the reduced link stands in its parent, an
    offset the plugin already had included. Other tags (<robotBaseFrame>, <linkName>) stay.

    Args:
        parents: reduced link -> its parent and its pose in the parent's frame.
    """
    element = plugin.element
    for tag in ('bodyName', 'frameName'):
        child = element.child(tag)
        if child is None or child.text not in parents:
            continue
        parent, frame = parents[child.text]
        element = _with_text(element, tag, parent)
        # Both tags usually name the same link; its offset counts once.
        if tag == 'frameName' and element is not plugin.element and _names_same(plugin.element):
            continue
        offset = compose(frame, Pose(_vector(element, 'xyzOffset'),
                                     from_rpy(*_vector(element, 'rpyOffset'))))
        element = _with_text(element, 'xyzOffset', _text(offset.position))
        element = _with_text(element, 'rpyOffset', _text(to_rpy(offset.orientation)))
    return replace(plugin, element=element)


def _names_same(element: Element) -> bool:
    body, frame = element.child('bodyName'), element.child('frameName')
    return body is not None and frame is not None and body.text == frame.text


def _vector(element: Element, tag: str) -> tuple[float, ...]:
    child = element.child(tag)
    return (parse_numbers(child.text, 3) if child is not None else None) or _ZERO


def _with_text(element: Element, tag: str, text: str) -> Element:
    """Return the element with the text of its first child `tag` replaced, or that child added."""
    old = element.child(tag)
    if old is None:
        new = Element(tag, text, line=element.line)
        return replace(element, children=(*element.children, new))
    new = replace(old, text=text)
    return replace(element, children=tuple(new if c is old else c for c in element.children))


def _text(values: tuple[float, ...]) -> str:
    # 0.0 + turns -0.0 into 0.0
    return ' '.join(f'{0.0 + value:.12g}' for value in values)
