"""The table of <gazebo> elements in doc/gazebo_compatibility.md agrees with the URDF reader."""

import logging

import pytest
from support.compatibility import rows
from support.urdf import INERTIAL, joint, link

from rosbots_description.sim.formats.urdf import gazebo_tags, link_tags
from rosbots_description.sim.formats.urdf.urdf import load_urdf

MISSING = 'not supported'
SHAPES = ''.join(
    f'<{tag}><geometry><sphere radius="1"/></geometry></{tag}>' for tag in ('collision', 'visual')
)
ROBOT = (
    f'<robot name="r">{link("a", INERTIAL + SHAPES)}{link("b")}{link("c")}'
    f'{joint("j", "a", "b", "fixed")}{joint("turning", "a", "c")}'
)
VALUES = (
    dict.fromkeys(('diffuse', 'ambient'), '1 0 0 1')
    | dict.fromkeys(('material', 'name'), 'Gazebo/Red')
    | {'fdir1': '1 0 0', 'gravity': '0'}
    | dict.fromkeys(
        ('static', 'selfCollide', 'self_collide', 'preserveFixedJoint', 'disableFixedJointLumping'),
        '1',
    )
)


ROWS = rows('URDF gazebo elements')


def robot(path):
    """Return the ROBOT with the element of a row in a <gazebo> block, as a model."""
    owner, *tags = path.split('/')
    joint = 'turning' if 'spring' in tags[-1] else 'j'
    reference = {'link': ' reference="a"', 'joint': f' reference="{joint}"', 'model': ''}[owner]
    text = VALUES.get(tags[-1], '2')
    for tag in reversed(tags):
        filename = ' filename="lib.so"' if tag == 'plugin' else ''
        text = f'<{tag}{filename}>{text}</{tag}>'
    return load_urdf(f'{ROBOT}<gazebo{reference}>{text}</gazebo></robot>', 'm')[0]


@pytest.mark.parametrize('name, state, how', ROWS)
def test_gazebo_element_agrees_with_its_row(name, state, how, caplog):
    plain = load_urdf(f'{ROBOT}</robot>', 'm')[0]
    with caplog.at_level(logging.DEBUG):
        changed = robot(name) != plain
    message = {record.getMessage(): record.levelno for record in caplog.records}
    if state != MISSING:
        assert changed
        assert message == {}
        return
    (sentence,) = message
    assert f'<{name.rpartition("/")[2]}>' in sentence
    assert (message[sentence] == logging.DEBUG) == ('level debug' in how)


def test_every_known_gazebo_element_has_a_row():
    tags = {*link_tags.SURFACE_NUMBERS, *link_tags.LINK_READERS, *gazebo_tags._PARTS}
    known = (
        {f'link/{tag}' for tag in tags - {'collision'}}
        | {f'link/collision/{path}' for path in link_tags.SURFACE_PATHS}
        | {f'joint/{tag}' for tag in gazebo_tags._JOINT_TAGS}
    )
    assert known <= {name for name, _, _ in ROWS}
