"""The <gazebo> blocks of a URDF: surfaces, materials, flags, sensors, plugins.

The tags and defaults are those of sdformat 9 (parser_urdf.cc).
Numbers may be given as text or in an attribute `value`. An invalid number is an error; an element
that is not simulated is named once. Different from Gazebo on purpose: the surface of a link also
applies to those of its collisions that have names of their own.
"""

import re
from collections.abc import Collection
from dataclasses import dataclass, field
from functools import partial
from typing import Literal, TypedDict

from lxml import etree

from ...core import (
    MAX_NOTES,
    Fault,
    fault,
    line_of,
    note,
    parse_number,
    shortened,
    suggestion,
    warn,
    warning,
)
from ...description import (
    FIXED,
    REVOLUTE,
    Colour,
    Material,
    PluginSpec,
    gazebo_material,
    material_of_colours,
)
from ...plugin_registry import library_remark
from ...resources import Addresses
from ..ogre import script_material
from ..xml import (
    LeftOut,
    boolean,
    is_endless,
    listed,
    read_sensor,
    scalar,
    scalar_number,
    scalar_numbers,
    tag_of,
    to_element,
)
from .link_tags import (
    LINK_READERS,
    SURFACE_NUMBERS,
    LinkTags,
    set_surface,
)

_NUMBER_TAGS = {
    *SURFACE_NUMBERS,
    'maxContacts',
    'dampingFactor',
    'springStiffness',
    'springReference',
}
_LEADING_NUMBER = re.compile(r'[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?(?=[^\w.]|f?$)')
_PARTS = ('light', 'projector')
# Stored and reported, but without effect here.
_KEPT = {'maxVel', 'minDepth', 'maxContacts'}
_KEPT_PATHS = {'surface/contact/ode/max_vel', 'surface/contact/ode/min_depth', 'max_contacts'}
# Settings of Gazebo's own solver, without a counterpart or visible effect here.
_SOLVER_TAGS = {
    'stopCfm',
    'stopErp',
    'provideFeedback',
    'implicitSpringDamper',
    'cfmDamping',
    'fudgeFactor',
    'canonicalBody',
}
_SPRING_TAGS: dict[str, Literal['stiffness', 'reference']] = {
    'springStiffness': 'stiffness',
    'springReference': 'reference',
}


class SpringTags(TypedDict, total=False):
    """Fields of JointSpec that the blocks of one joint set."""

    stiffness: float
    reference: float


@dataclass
class GazeboTags:
    """The contents of all blocks."""

    addresses: Addresses
    links: dict[str, LinkTags] = field(default_factory=dict)
    kept_joints: dict[str, str] = field(default_factory=dict)  # fixed joint -> its joint type
    joints: dict[str, SpringTags] = field(default_factory=dict)
    static: bool = False
    plugins: list[PluginSpec] = field(default_factory=list)
    notes: list[Fault] = field(default_factory=list)  # warnings
    idle: list[str] = field(default_factory=list)  # elements without effect here
    left_out: LeftOut = field(default_factory=LeftOut)


def _leading_numbers(block: etree._Element, tags: GazeboTags) -> None:
    """Remove empty numeric tags, and text after their number, in place; Gazebo ignores the latter.

    Examples are '0.5;' and '0.5 0.5'.
    """
    for child in list(block):
        if child.tag not in _NUMBER_TAGS or parse_number(scalar(child)) is not None:
            continue
        if not scalar(child):
            warn(tags.notes, child, f'<{child.tag}> is empty and ignored', 'give it a number')
            block.remove(child)
            continue
        found = _LEADING_NUMBER.match(scalar(child))
        if found and not is_endless(child):
            written = f'of <{child.tag}> {shortened(scalar(child), 60)!r}'
            warn(tags.notes, child, f'{written} only the number {found[0]} is read, as in Gazebo')
            child.attrib.pop('value', '')
            child.text = found[0]


def read_gazebo_tags(
    robot: etree._Element,
    links: Collection[str],
    joints: Collection[str],
    addresses: Addresses,
) -> GazeboTags:
    """Read all <gazebo> blocks below <robot>.

    Args:
        links, joints: the names a `reference` may have.
        addresses: of material scripts.
    Raises:
        ModelError: a value that must be a finite number is not one.
    """
    tags, names = GazeboTags(addresses), [*links, *joints]
    links, joints = set(links), set(joints)
    unread: list[str] = []
    for block in robot.findall('gazebo'):
        _leading_numbers(block, tags)
        reference = block.get('reference')
        if not reference:
            _read_model_block(block, tags, unread)
            continue
        if reference in links:
            _read_link_block(block, tags.links.setdefault(reference, LinkTags()), tags, unread)
        if reference in joints:
            _read_joint_block(block, reference, tags, unread if reference not in links else [])
        if reference not in links and reference not in joints:
            note(tags.notes, partial(_unknown, block, reference, names))
    if unread:
        mentioned = listed(list(dict.fromkeys(unread)), MAX_NOTES)
        tags.notes.append(Fault(f'not simulated in <gazebo> blocks: {mentioned}'))
    return tags


def _unknown(block: etree._Element, reference: str, names: Collection[str]) -> Fault:
    return warning(
        block,
        'there is no link or joint of that name; the block is '
        f'ignored{suggestion(reference, names)}',
    )


def _read_model_block(block: etree._Element, tags: GazeboTags, unread: list[str]) -> None:
    for child in block:
        match child.tag:
            case 'static':
                tags.static = boolean(child)
            case 'plugin':
                _read_plugin(child, tags)
            case _:
                unread.append(_mention(child))


def _read_plugin(element: etree._Element, tags: GazeboTags) -> None:
    filename = element.get('filename', '').strip()
    if not filename:
        cure = 'add filename="libgazebo_ros_….so"'
        warn(tags.notes, element, 'a <plugin> without filename is ignored', cure)
        return
    tags.plugins.append(PluginSpec(element.get('name', ''), filename, to_element(element)))


def _read_link_block(
    block: etree._Element, link: LinkTags, tags: GazeboTags, unread: list[str]
) -> None:
    for child in block:
        tag = child.tag
        if tag in _KEPT:
            tags.idle.append(_mention(child))
        if tag in SURFACE_NUMBERS:
            set_surface(link, SURFACE_NUMBERS[tag], child)
        elif tag in LINK_READERS:
            LINK_READERS[tag](child, link)
            if tag == 'collision':
                kept = [child.find(path) for path in sorted(_KEPT_PATHS)]
                tags.idle += [_mention(part) for part in kept if part is not None]
        elif tag == 'material':
            _read_script(child, link, tags)
        elif tag == 'visual':
            _read_visual(child, link, tags)
        elif tag not in _JOINT_TAGS:
            _read_part(child, link, tags, unread)


def _read_part(
    element: etree._Element, link: LinkTags, tags: GazeboTags, unread: list[str]
) -> None:
    match element.tag:
        case 'sensor':
            link.sensors.append(read_sensor(element, partial(warn, tags.notes)))
        case 'plugin':
            _mention_plugin(element, tags)
        case tag:
            if tag in _PARTS:
                link.parts.append(to_element(element))
            unread.append(_mention(element))


def _mention_plugin(element: etree._Element, tags: GazeboTags) -> None:
    filename = element.get('filename', '').strip()
    note(
        tags.notes,
        lambda: warning(
            element,
            f'a <plugin> of a link is not run, as in Gazebo; {library_remark(filename)}',
            'move it to a <gazebo> without reference',
        ),
    )


def _read_script(element: etree._Element, link: LinkTags, tags: GazeboTags) -> None:
    script = scalar(element)
    block = next(element.iterancestors('material'), element)
    material = gazebo_material(script) or script_material(block, script, tags.addresses)
    if material is None:
        what = f"material '{shortened(script, 60)}' is neither one of Gazebo's nor in a script"
        what += ' along GAZEBO_RESOURCE_PATH; grey is shown'
        warn(tags.notes, element, what, 'write e.g. Gazebo/Red')
        material = Material(script=script)
    link.material = material


def _read_visual(element: etree._Element, link: LinkTags, tags: GazeboTags) -> None:
    name = element.find('material/script/name')
    if name is not None:
        _read_script(name, link, tags)
    colours: dict[str, Colour] = {}
    for tag in ('ambient', 'diffuse', 'specular', 'emissive'):
        colour = element.find(f'material/{tag}')
        if colour is not None:
            red, green, blue, alpha = scalar_numbers(colour, 4)
            colours[tag] = (red, green, blue, alpha)
    if colours:
        link.material = material_of_colours(link.material or Material(), **colours)


_JOINT_TAGS = {*_SOLVER_TAGS, *_SPRING_TAGS, 'disableFixedJointLumping', 'preserveFixedJoint'}


def _read_joint_block(
    block: etree._Element, joint: str, tags: GazeboTags, unread: list[str]
) -> None:
    for child in block:
        match child.tag:
            case 'preserveFixedJoint':
                if boolean(child):
                    tags.kept_joints[joint] = FIXED
            case 'disableFixedJointLumping':
                if boolean(child):
                    # If both are given, preserveFixedJoint wins in either order.
                    tags.kept_joints.setdefault(joint, REVOLUTE)
            case tag if tag in _SPRING_TAGS:
                value = scalar_number(child)
                if value < 0.0 and tag == 'springStiffness':
                    raise fault(child, f'<{tag}> is {value:g}; it must not be negative')
                tags.joints.setdefault(joint, SpringTags())[_SPRING_TAGS[tag]] = value
            case tag:
                (tags.idle if tag in _SOLVER_TAGS else unread).append(_mention(child))


def _mention(element: etree._Element) -> str:
    return f'<{shortened(tag_of(element), 60)}> ({line_of(element)})'
