"""The robot's xacro agrees with the article and gives the documented TF trees."""

import json
import math
import os
from xml.etree import ElementTree

import pytest
from support import ROOT, XACRO, robot_spec, robot_urdf
from support.programs import ran

from rosbots_description.sim.description.model_spec import Mesh

ARTICLE = json.loads((ROOT / 'test' / 'data' / 'article_robot.json').read_text(encoding='utf-8'))
TOLERANCE = 1e-9  # in the unit of each number


def robot(**arguments: str) -> ElementTree.Element:
    return ElementTree.fromstring(robot_urdf(**arguments))


def numbers(text: str) -> list:
    return [float(word) for word in text.split()]


def origin(element: ElementTree.Element) -> dict:
    return {key: numbers(element.find('origin').get(key)) for key in ('xyz', 'rpy')}


def shape(geometry: ElementTree.Element) -> dict:
    (element,) = geometry
    meaning = {'shape': element.tag}
    for key, value in element.attrib.items():
        meaning[key] = {'filename': str, 'scale': numbers}.get(key, float)(value)
    return meaning


def link_meaning(link: ElementTree.Element) -> dict:
    meaning = {}
    for part in link:
        assert part.tag not in meaning, f'{link.get("name")} has two {part.tag}'
        meaning[part.tag] = {'origin': origin(part)}
        if part.tag == 'inertial':
            assert {child.tag for child in part} == {'origin', 'mass', 'inertia'}
            meaning[part.tag]['mass'] = float(part.find('mass').get('value'))
            meaning[part.tag]['inertia'] = {
                key: float(value) for key, value in part.find('inertia').attrib.items()
            }
        else:
            assert {child.tag for child in part} == {'origin', 'geometry'}
            meaning[part.tag]['geometry'] = shape(part.find('geometry'))
    return meaning


def joint_meaning(joint: ElementTree.Element) -> dict:
    meaning = {
        'type': joint.get('type'),
        'parent': joint.find('parent').get('link'),
        'child': joint.find('child').get('link'),
        'origin': origin(joint),
    }
    if joint.find('axis') is not None:
        meaning['axis'] = numbers(joint.find('axis').get('xyz'))
    assert {child.tag for child in joint} <= {'parent', 'child', 'origin', 'axis'}
    return meaning


def parameters(tree: ElementTree.Element) -> dict:
    return {child.tag: child.text for child in tree.find('gazebo/plugin')}


def assert_same(actual, expected, where: str) -> None:
    """Compare nested values; numbers to TOLERANCE, everything else exactly."""
    if isinstance(expected, dict):
        assert set(actual) == set(expected), where
        for key in expected:
            assert_same(actual[key], expected[key], f'{where} {key}')
    elif isinstance(expected, list):
        assert len(actual) == len(expected), where
        for i, (one, other) in enumerate(zip(actual, expected, strict=True)):
            assert_same(one, other, f'{where}[{i}]')
    elif isinstance(expected, float):
        assert actual == pytest.approx(expected, abs=TOLERANCE, rel=0.0), where
    else:
        assert actual == expected, where


def test_robot_has_the_articles_parts_and_nothing_else():
    tree = robot()
    assert tree.get('name') == ARTICLE['name']
    assert {child.tag for child in tree} == {'link', 'joint', 'gazebo'}
    assert len(tree.findall('link')) == 17
    assert len(tree.findall('joint')) == 16
    (plugin,) = (block for block in tree.findall('gazebo') if block.get('reference') is None)
    assert [child.tag for child in plugin] == ['plugin']
    assert {link.get('name') for link in tree.findall('link')} == set(ARTICLE['links'])
    assert {joint.get('name') for joint in tree.findall('joint')} == set(ARTICLE['joints'])


@pytest.mark.parametrize('name', ARTICLE['links'])
def test_link_is_the_articles(name):
    assert_same(link_meaning(robot().find(f"link[@name='{name}']")), ARTICLE['links'][name], name)


@pytest.mark.parametrize('name', ARTICLE['joints'])
def test_joint_is_the_articles(name):
    joint = robot().find(f"joint[@name='{name}']")
    assert_same(joint_meaning(joint), ARTICLE['joints'][name], name)


def test_plugin_is_the_articles_parameter_by_parameter():
    (plugin,) = robot().find('gazebo')
    assert plugin.get('name') == ARTICLE['plugin']['name']
    assert plugin.get('filename') == ARTICLE['plugin']['filename']
    assert len(plugin) == len(ARTICLE['plugin']['parameters'])
    assert parameters(robot()) == ARTICLE['plugin']['parameters']


def test_one_tf_tree_changes_two_parameters_and_nothing_else():
    default, one_tree = robot(), robot(one_tf_tree='true')
    assert parameters(one_tree) == {
        **parameters(default),
        'robotBaseFrame': 'base_footprint',
        'publishWheelTF': 'false',
    }
    for tree in (default, one_tree):
        tree.remove(tree.find('gazebo'))
    assert ElementTree.tostring(default) == ElementTree.tostring(one_tree)


# Argument of the xacro -> what it adds: links, and sensors as (link, type, library).
ADDED = {
    'camera': (
        {'camera_link', 'camera_link_optical'},
        {('camera_link', 'camera', 'libgazebo_ros_camera.so')},
    ),
    'imu': ({'imu_link'}, {('imu_link', 'imu', 'libgazebo_ros_imu_sensor.so')}),
    'laser': ({'laser_link'}, {('laser_link', 'ray', 'libgazebo_ros_laser.so')}),
    'bumper': (set(), {('base_link', 'contact', 'libgazebo_ros_bumper.so')}),
    'surfaces': (set(), set()),
}


def sensors(elements: list[ElementTree.Element]) -> set:
    return {
        (block.get('reference'), sensor.get('type'), sensor.find('plugin').get('filename'))
        for block in elements
        for sensor in block.findall('sensor')
    }


def added(**arguments: str) -> list[ElementTree.Element]:
    """Return the elements behind those of the robot without arguments, which must be the same."""
    plain, more = list(robot()), list(robot(**arguments))
    for one, other in zip(plain, more, strict=False):
        assert ElementTree.tostring(one).strip() == ElementTree.tostring(other).strip()
    return more[len(plain) :]


@pytest.mark.parametrize('argument', ADDED)
def test_an_argument_adds_its_sensor_and_nothing_else(argument):
    links, expected = ADDED[argument]
    elements = added(**{argument: 'true'})
    new = {
        tag: [element for element in elements if element.tag == tag]
        for tag in ('link', 'joint', 'gazebo')
    }
    assert sum(map(len, new.values())) == len(elements) > 0
    assert {link.get('name') for link in new['link']} == links
    assert {joint.find('child').get('link') for joint in new['joint']} == links
    assert {joint.get('type') for joint in new['joint']} <= {'fixed'}
    # They have neither mass nor collisions: the robot drives as it does without them.
    assert {part.tag for link in new['link'] for part in link} <= {'visual'}
    assert sensors(new['gazebo']) == expected
    assert added(**{argument: 'false'}) == []


def test_argument_depth_selects_a_depth_camera():
    assert sensors(added(camera='true', depth='true')) == {
        ('camera_link', 'depth', 'libgazebo_ros_openni_kinect.so')
    }
    assert added(depth='true') == []


def test_camera_has_the_given_pitch_and_the_frames_of_rep_103():
    tree = robot(camera='true', camera_pitch='0.6')
    assert origin(tree.find("joint[@name='camera_joint']"))['rpy'] == [0.0, 0.6, 0.0]
    joint = tree.find("joint[@name='camera_optical_joint']")
    assert origin(joint)['rpy'] == pytest.approx([-math.pi / 2, 0.0, -math.pi / 2])
    # Pictures are taken where that frame is.
    sensor = tree.find(".//sensor[@name='camera1']")
    assert numbers(sensor.findtext('pose')) == [*origin(joint)['xyz'], 0.0, 0.0, 0.0]
    assert sensor.findtext('plugin/frameName') == 'camera_link_optical'


def test_surfaces_are_those_of_the_course():
    blocks = {
        block.get('reference'): {child.tag: child.text for child in block}
        for block in added(surfaces='true')
    }
    tyre = {
        'mu1': '1.0',
        'mu2': '1.0',
        'kp': '1000000.0',
        'kd': '100.0',
        'minDepth': '0.001',
        'maxVel': '1.0',
    }
    assert blocks == {
        'wheel_left_link': tyre,
        'wheel_right_link': tyre,
        'base_link': {'material': 'Gazebo/Blue', 'mu1': '0.3', 'mu2': '0.3'},
    }


def tf_parents(tree: ElementTree.Element) -> dict:
    """Return for each TF frame all its parents, with a robot_state_publisher beside the plugin."""
    joints = tree.findall('joint')
    parents = {
        joint.find('child').get('link'): [joint.find('parent').get('link')] for joint in joints
    }
    fixed = {
        joint.find('child').get('link'): joint.find('parent').get('link')
        for joint in joints
        if joint.get('type') == 'fixed'
    }
    plugin = parameters(tree)
    parents.setdefault(plugin['robotBaseFrame'], []).append(plugin['odometryFrame'])
    for side in ('leftJoint', 'rightJoint'):
        if plugin['publishWheelTF'] == 'true':
            joint = tree.find(f"joint[@name='{plugin[side]}']")
            parent = joint.find('parent').get('link')
            while parent in fixed:  # the simulator merges links joined by fixed joints
                parent = fixed[parent]
            parents[joint.find('child').get('link')].append(parent)
    return parents


def test_base_link_and_wheels_have_two_parents_by_default_as_in_the_article():
    twice = {frame for frame, parents in tf_parents(robot()).items() if len(parents) > 1}
    assert twice == {'base_link', 'wheel_left_link', 'wheel_right_link'}


def test_one_tf_tree_gives_every_frame_one_parent_below_odom():
    tree = robot(one_tf_tree='true')
    parents = tf_parents(tree)
    assert all(len(several) == 1 for several in parents.values())
    assert set(parents) == set(ARTICLE['links'])
    assert parents['base_footprint'] == ['odom']
    assert parents['base_link'] == ['base_footprint']
    # Without the plugin's wheel transforms the wheels need its joint states.
    assert parameters(tree)['publishWheelJointState'] == 'true'


def test_check_urdf_accepts_the_robot(tmp_path):
    path = tmp_path / 'rosbots.urdf'
    path.write_text(robot_urdf(), encoding='utf-8')
    result = ran('check_urdf', path)
    assert result.returncode == 0, result.stderr
    assert 'root Link: base_footprint' in result.stdout


def test_xacro_is_executable():
    assert os.access(XACRO, os.X_OK)


def test_every_mesh_of_the_robot_is_in_the_package():
    files = {mesh.get('filename') for mesh in robot().iter('mesh')}
    assert len(files) == 4
    for name in files:
        prefix, path = name[:30], name[30:]
        assert prefix == 'package://rosbots_description/'
        assert (ROOT / path).is_file(), name


def test_links_without_colour_are_red_as_in_rviz():
    urdf = robot()
    red = {
        block.get('reference')
        for block in urdf.findall('gazebo')
        if block.findtext('material') == 'Gazebo/Red'
    }
    colourless = {
        link.get('name')
        for link in urdf.findall('link')
        for visual in link.findall('visual')
        if visual.find('material') is None and visual.find('geometry/mesh') is None
    }
    assert red == colourless
    shown = {
        visual.material and visual.material.rgba
        for link in robot_spec().links
        for visual in link.visuals
        if not isinstance(visual.geometry, Mesh)
    }
    assert shown == {(1.0, 0.0, 0.0, 1.0)}
