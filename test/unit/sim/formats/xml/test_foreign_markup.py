"""Markup other than URDF or SDF is ignored as in Gazebo, and reported as written."""

import logging

import pytest

from rosbots_description.ros_api.clients.model_source import canonical_xml
from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.resources.search_path import ModelSearch

LINK = '<link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'
CURE = 'run it through xacro first, e.g. command="xacro FILE" in the launch file'


def load(body, head=''):
    text = canonical_xml(f'<robot name="r"{head}>\n{body}</robot>')  # as spawn_model sends it
    return load_urdf(text, 'bot', source='bot.urdf')[0]


@pytest.mark.parametrize('head', ['', ' xmlns:xacro="http://www.ros.org/wiki/xacro"'])
def test_tags_of_xacro_are_ignored_and_reported_as_written(head, caplog):
    spec = load(
        '<xacro:include filename="$(find p)/a.xacro"/>\n<xacro:macro name="m">'
        f'<link name="${{x}}"/><xacro:m/></xacro:macro>{LINK}</link>',
        head,
    )
    assert [link.name for link in spec.links] == ['a']
    assert caplog.messages == [
        "model 'bot' (bot.urdf): unexpanded xacro is ignored: "
        '<xacro:include filename="$(find p)/a.xacro"> (line 2), <xacro:macro name="m"> (line 3); '
        + CURE
    ]


def test_unexpanded_text_other_than_numbers_is_accepted(caplog):
    named = LINK.replace('"a"', '"${p}a"')
    assert load(f'{named}</link>').links[0].name == '${p}a'
    spec = load(
        f'{LINK}</link><gazebo><plugin name="p" filename="libx.so"><ns>$(arg n)/a</ns>'
        '</plugin></gazebo>'
    )
    assert spec.plugins[0].element.child('ns').text == '$(arg n)/a'
    assert f'taken literally: $(arg n)/a in <ns> (line 2); {CURE}' in caplog.messages[-1]


@pytest.mark.parametrize(
    'body',
    [
        LINK.replace('value="1"', 'value="${m}"') + '</link>',
        LINK + '<collision><geometry><box size="${a} 1 1"/></geometry></collision></link>',
        LINK + '</link><gazebo reference="a"><mu1>$(arg mu)</mu1></gazebo>',
    ],
)
def test_unexpanded_number_is_rejected_with_the_cure(body):
    with pytest.raises(ModelError, match=r'bot.urdf, line 2: .* is unexpanded xacro; run it'):
        load(body)


def test_mesh_with_an_unexpanded_address_is_left_out(caplog):
    spec = load(
        f'{LINK}<visual><geometry><mesh filename="$(find p)/m.dae"/></geometry></visual></link>'
    )
    assert spec.links[0].visuals == ()
    assert [r.levelno for r in caplog.records] == [logging.ERROR, logging.WARNING]
    assert "left out: visual of link 'a' (line 2)" in caplog.messages[0]
    assert CURE in caplog.messages[1]


def test_other_prefixes_are_reported_outside_of_gazebo_blocks(caplog):
    load(f'<sensor:ray a="1"/>{LINK}<x:y/></link><gazebo><controller:c/></gazebo>')
    assert caplog.messages[0] == (
        'model \'bot\' (bot.urdf): tags of another namespace are ignored: <sensor:ray a="1"> '
        '(line 2), <x:y> (line 2)'
    )
    assert '<controller:c> (line 2)' in caplog.messages[1]


def test_unexpanded_xacro_in_sdf_is_reported(caplog):
    text = '<sdf version="1.6"><model name="m">\n<xacro:box/><link name="l"/></model></sdf>'
    assert load_sdf(text, 'bot', source='b.sdf', find_model=ModelSearch())[0].links
    assert caplog.messages == [f'b.sdf: unexpanded xacro is ignored: <xacro:box> (line 2); {CURE}']


def test_ten_thousand_nested_tags_of_xacro_are_found_quickly():
    deep = '<a>' * 150 + '<xacro:x/>' * 10_000 + '</a>' * 150
    assert load(f'{LINK}</link>{deep}').links
