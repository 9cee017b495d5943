"""Markup of other languages in a description: unexpanded xacro, foreign namespaces.

As in Gazebo a tag of another namespace is ignored with all its content, and an unexpanded
expression is plain text. Where a number is needed that is an error; see `values`.
"""

from lxml import etree

from ...core import line_of, shortened
from .omissions import listed
from .values import XACRO_CURE, attributes_of, is_expression, tag_of

_MOST = 6  # tags and expressions that a warning lists
_XACRO = 'xacro:'
_OWN = ('gazebo', 'plugin', 'sensor')  # their content is interpreted by their readers


def remove_xacro(root: etree._Element) -> list[str]:
    """Remove all tags of xacro, in place; return the warnings."""
    tags = _outermost(root)
    shown = [_opening(element) for _, element in tags]
    for parent, element in tags:
        parent.remove(element)
    notes = []
    if shown:
        notes.append(f'unexpanded xacro is ignored: {listed(shown, _MOST)}; {XACRO_CURE}')
    expressions = _expressions(root)
    if expressions:
        written = listed(expressions, _MOST)
        notes.append(f'unexpanded xacro is taken literally: {written}; {XACRO_CURE}')
    return notes


def foreign_tags(robot: etree._Element) -> list[str]:
    """Return the warning about tags of a URDF with a prefix, if any."""
    shown = [
        _opening(element)
        for child in robot
        if child.tag not in _OWN
        for element in child.iter(etree.Element)
        if ':' in tag_of(element)
    ]
    return [f'tags of another namespace are ignored: {listed(shown, _MOST)}'] if shown else []


def _outermost(parent: etree._Element) -> list[tuple[etree._Element, etree._Element]]:
    """Return the outermost tags of xacro, each as (parent, tag)."""
    found = []
    for child in parent:
        found += [(parent, child)] if tag_of(child).startswith(_XACRO) else _outermost(child)
    return found


def _opening(element: etree._Element) -> str:
    attributes = ''.join(f' {key}="{value}"' for key, value in attributes_of(element).items())
    return f'<{shortened(tag_of(element) + attributes, 100)}> ({line_of(element)})'


def _expressions(root: etree._Element) -> list[str]:
    found = []
    for element in root.iter(etree.Element):
        places = [(f'{key}="{value}"', value) for key, value in attributes_of(element).items()]
        places.append(((element.text or '').strip(), element.text or ''))
        found += [
            f'{shortened(shown, 100)} in <{tag_of(element)}> ({line_of(element)})'
            for shown, value in places
            if is_expression(value)
        ]
    return found
