"""Poses of SDF in all kinds of frames, and nested models."""

import math

import pytest

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.resources.search_path import ModelSearch

QUARTER = math.pi / 2


def load(body, version='1.7'):
    text = f'<sdf version="{version}"><model name="m">{body}</model></sdf>'
    return load_sdf(text, 'm', source='m.sdf', find_model=ModelSearch())[0]


def link(name, pose, attributes=''):
    return f'<link name="{name}"><pose {attributes}>{pose}</pose></link>'


def positions(spec):
    return {made.name: pytest.approx(made.pose.position, abs=1e-9) for made in spec.links}


def test_links_are_posed_in_their_model():
    assert positions(load(link('a', '1 0 0 0 0 0') + link('b', '0 2 0 0 0 0'))) == {
        'a': (1.0, 0.0, 0.0),
        'b': (0.0, 2.0, 0.0),
    }


def test_pose_may_be_relative_to_a_later_link():
    spec = load(link('a', '1 0 0 0 0 0', 'relative_to="b"') + link('b', f'0 0 1 0 0 {QUARTER}'))
    assert positions(spec)['a'] == (0.0, 1.0, 1.0)


def test_attribute_frame_is_relative_to_before_sdf_1_7():
    spec = load(link('a', '1 0 0 0 0 0', 'frame="b"') + link('b', f'0 0 1 0 0 {QUARTER}'), '1.6')
    assert positions(spec)['a'] == (0.0, 1.0, 1.0)


def test_an_empty_frame_is_the_default_one():
    assert positions(load(link('a', '1 0 0 0 0 0', 'frame=""'), '1.6'))['a'] == (1.0, 0.0, 0.0)


def test_poses_may_be_relative_to_named_frames():
    spec = load(
        '<frame name="f" attached_to="b"><pose>0 0 5 0 0 0</pose></frame>'
        + link('b', '1 0 0 0 0 0')
        + link('a', '0 1 0 0 0 0', 'relative_to="f"')
    )
    assert positions(spec)['a'] == (1.0, 1.0, 5.0)


def test_collision_posed_in_another_frame_is_transformed_into_its_link():
    shape = '<geometry><sphere><radius>1</radius></sphere></geometry>'
    spec = load(f"""<link name="a"><pose>1 0 0 0 0 {QUARTER}</pose>
      <collision name="c"><pose relative_to="__model__">0 0 0 0 0 0</pose>{shape}</collision>
      <visual name="v"><pose>0 0 1 0 0 0</pose>{shape}</visual></link>""")
    made = spec.links[0]
    assert made.collisions[0].pose.position == pytest.approx((0.0, 1.0, 0.0))
    assert made.visuals[0].pose == Pose((0.0, 0.0, 1.0))


def test_sensor_posed_in_another_frame_is_transformed_into_its_link():
    spec = load("""<link name="a"><pose>1 0 0 0 0 0</pose><sensor name="s" type="ray">
      <pose relative_to="__model__">1 0 2 0 0 0</pose><always_on>1</always_on></sensor></link>""")
    (sensor,) = spec.links[0].sensors
    assert sensor.pose == Pose((0.0, 0.0, 2.0))
    assert sensor.always_on


def test_poses_may_be_relative_to_a_joint():
    spec = load(
        """<joint name="j" type="fixed"><parent>a</parent><child>b</child>
      <pose>0 0 1 0 0 0</pose></joint>"""
        + link('a', '0 0 0 0 0 0')
        + link('b', '1 0 0 0 0 0')
        + link('c', '0 1 0 0 0 0', 'relative_to="j"')
    )
    assert positions(spec)['c'] == (1.0, 1.0, 1.0)


def test_cyclic_frames_are_rejected():
    with pytest.raises(ModelError, match='posed relative to itself'):
        load(
            link('a', '0 0 0 0 0 0', 'relative_to="b"')
            + link('b', '0 0 0 0 0 0', 'relative_to="a"')
        )


def test_long_chain_of_frames_is_resolved():
    chain = ''.join(
        f'<frame name="f{i}"><pose relative_to="f{i + 1}">1 0 0 0 0 0</pose></frame>'
        for i in range(3000)
    )
    spec = load(chain + '<frame name="f3000"/>' + link('a', '0 0 0 0 0 0', 'relative_to="f0"'))
    assert positions(spec)['a'] == (3000.0, 0.0, 0.0)


def test_error_about_an_unknown_frame_suggests_a_similar_one():
    with pytest.raises(ModelError, match=r"'bse'.*did you mean 'base'"):
        load(link('base', '0 0 0 0 0 0') + link('a', '0 0 0 0 0 0', 'relative_to="bse"'))


NESTED = f"""<link name="base"/>
  <model name="arm"><pose>0 0 1 0 0 {QUARTER}</pose>
    <link name="upper"><pose>1 0 0 0 0 0</pose>
      <sensor name="s" type="ray"><frame>upper</frame></sensor></link>
    <link name="lower"><pose>2 0 0 0 0 0</pose></link>
    <joint name="elbow" type="revolute"><parent>upper</parent><child>lower</child>
      <axis><xyz>0 1 0</xyz></axis></joint>
    <plugin name="p" filename="lib.so"><jointName>elbow</jointName><topic>other</topic></plugin>
  </model>
  <joint name="shoulder" type="fixed"><parent>base</parent><child>arm::upper</child></joint>
"""


def test_nested_models_become_one_with_scoped_names():
    spec = load(NESTED)
    assert positions(spec) == {
        'base': (0.0, 0.0, 0.0),
        'arm::upper': (0.0, 1.0, 1.0),
        'arm::lower': (0.0, 2.0, 1.0),
    }
    joints = {joint.name: joint for joint in spec.joints}
    assert (joints['arm::elbow'].parent, joints['arm::elbow'].child) == ('arm::upper', 'arm::lower')
    assert joints['arm::elbow'].axis == (0.0, 1.0, 0.0)
    assert (joints['shoulder'].parent, joints['shoulder'].child) == ('base', 'arm::upper')


def test_names_in_plugins_and_sensors_of_nested_models_become_scoped():
    spec = load(NESTED)
    plugin = spec.plugins[0].element
    assert (plugin.child('jointName').text, plugin.child('topic').text) == ('arm::elbow', 'other')
    assert spec.link('arm::upper').sensors[0].element.child('frame').text == 'arm::upper'


def test_static_model_nested_in_a_movable_one_is_fixed():
    spec = load('<link name="a"/><model name="post"><static>1</static><link name="b"/></model>')
    assert not spec.static
    assert [made.kinematic for made in spec.links] == [False, True]


def test_models_nested_in_a_static_one_are_static():
    spec = load('<static>1</static><link name="a"/><model name="in"><link name="b"/></model>')
    assert spec.static
    assert spec.links[1].inertial is None


def test_poses_are_composed_through_nested_models():
    inner = '<link name="a"><pose>0 0 1 0 0 0</pose></link>'
    for name in ('one', 'two', 'three'):
        inner = f'<model name="{name}"><pose>1 0 0 0 0 0</pose>{inner}</model>'
    assert positions(load(inner)) == {'three::two::one::a': (3.0, 0.0, 1.0)}
