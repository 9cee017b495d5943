"""Reads <sensor> elements, which URDF and SDF share."""

from collections.abc import Callable

from lxml import etree

from ...core import (
    IDENTITY,
    Pose,
    from_rpy,
    parse_number,
    parse_numbers,
    shortened,
)
from ...description import PluginSpec, SensorSpec
from .values import boolean, scalar, to_element

Complain = Callable[[etree._Element, str], object]


def read_sensor(
    element: etree._Element, complain: Complain, pose: Pose | None = None
) -> SensorSpec:
    """Return the sensor of a <sensor>; one number that is none costs no sensor.

    Args:
        complain: takes the element and a sentence for each thing that is done differently.
        pose: in the link's frame, where the caller knows it; else the element's own counts.
    """
    plugins = []
    for child in element.iterfind('plugin'):
        filename = child.get('filename', '').strip()
        if filename:
            plugins.append(PluginSpec(child.get('name', ''), filename, to_element(child)))
        else:
            complain(
                child,
                'a <plugin> without filename is ignored; '
                'filename="libgazebo_ros_….so" picks the code',
            )
    return SensorSpec(
        name=element.get('name', ''),
        type=element.get('type', '').strip(),
        pose=_own_pose(element, complain) if pose is None else pose,
        update_rate=_rate(element, complain),
        always_on=_says_true(element, 'always_on'),
        visualize=_says_true(element, 'visualize'),
        topic=_text(element, 'topic'),
        plugins=tuple(plugins),
        element=to_element(element),
    )


def _own_pose(element: etree._Element, complain: Complain) -> Pose:
    child = element.find('pose')
    if child is None:
        return IDENTITY
    text = child.text or ''
    numbers = parse_numbers(text, 6)
    if numbers is None:
        complain(
            child,
            f"<pose> is '{shortened(text, 60)}'; it takes six finite "
            "numbers. The sensor is at its link's origin",
        )
        return IDENTITY
    x, y, z, *angles = numbers
    return Pose((x, y, z), from_rpy(*angles))


def _rate(element: etree._Element, complain: Complain) -> float:
    child = element.find('update_rate')
    if child is None:
        return 0.0
    rate = parse_number(scalar(child))
    if rate is None:
        complain(
            child,
            f"<update_rate> is '{shortened(scalar(child), 60)}'; it takes "
            'a finite number [Hz]. The sensor measures in every step',
        )
        return 0.0
    return max(0.0, rate)


def _says_true(element: etree._Element, tag: str) -> bool:
    child = element.find(tag)
    return child is not None and boolean(child)


def _text(element: etree._Element, tag: str) -> str:
    child = element.find(tag)
    return '' if child is None else scalar(child)
