"""Poses of SDF that are too short or too long, as Gazebo reads them."""

from lxml import etree

from ...core import parse_numbers, shortened
from ..xml import scalar

_NUMBERS = 6  # x y z roll pitch yaw
_FOREIGN = ('plugin',)  # their content is interpreted by their readers


def complete_poses(root: etree._Element) -> list[tuple[etree._Element, str]]:
    """Make each numeric <pose> have six numbers, in place; return each, with a warning.

    As in Gazebo missing numbers are 0, and excess ones are ignored.
    """
    completed = []
    for element in root.iter('pose'):
        text = scalar(element)
        count = len(text.split())
        if count in (0, _NUMBERS) or parse_numbers(text, count) is None or _is_foreign(element):
            continue
        if count == 7 and element.get('rotation_format') == 'quat_xyzw':
            continue
        element.text = ' '.join([*text.split(), *'000000'][:_NUMBERS])
        sentence = (
            f'a <pose> has six numbers, this one has {count}: '
            f"'{shortened(text, 100)}' is read as '{shortened(element.text, 100)}'"
        )
        completed.append((element, sentence))
    return completed


def _is_foreign(element: etree._Element) -> bool:
    return any(ancestor.tag in _FOREIGN for ancestor in element.iterancestors())
