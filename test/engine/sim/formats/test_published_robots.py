"""Irregular robots, as published and accepted by Gazebo, are simulated with warnings."""

import pytest
from support import empty_world, urdf

from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.resources.search_path import ModelSearch

DROP, STEPS = 0.5, 1000  # [m], [ms] until the robot stands
THICK = 0.1  # [m]
HIGHEST, LOWEST = 0.6, 0.04  # [m] of the box, lying, tilted or under another one

BOX = f'<geometry><box size="0.4 0.3 {THICK}"/></geometry>'
BODY = f'{urdf.inertial(1.0, 0.1)}<collision>{BOX}</collision><visual>{BOX}</visual>'
PLUGIN = '<plugin name="p" filename="{}"><ns>/</ns><a b="c"><d/></a></plugin>'


def link(name='a', inside=BODY):
    return urdf.link(name, inside)


def joint(kind='continuous', inside='<axis xyz="0 1 0"/>'):
    return urdf.joint('to_b', 'a', 'b', kind, f'<origin xyz="0 0 0.3"/>{inside}')


def look(shape='<sphere radius="0.01"/>', more=''):
    return link('a', f'{BODY}<visual><geometry>{shape}</geometry>{more}</visual>')


def gazebo(inside, reference='a'):
    return link() + f'<gazebo reference="{reference}">{inside}</gazebo>'


TWO = link('a') + link('b')
NO_MASS = urdf.inertial(0, 0)
# Irregularity -> the robot, and the number of log lines about it.
ROBOTS = {
    'root without mass': (
        link('base_footprint', '') + link() + urdf.joint('f', 'base_footprint', 'a', 'fixed'),
        0,
    ),
    'frames without anything': (
        link()
        + link('b', '')
        + link('c', '')
        + joint('fixed')
        + urdf.joint('o', 'b', 'c', 'fixed'),
        0,
    ),
    'fixed joint with an axis of zeros': (TWO + joint('fixed', '<axis xyz="0 0 0"/>'), 0),
    'axis of zeros': (TWO + joint(inside='<axis xyz="0 0 0"/>'), 1),
    'axis that is no unit vector': (TWO + joint(inside='<axis xyz="0 3 4"/>'), 0),
    'link without mass on a joint': (link() + link('b', NO_MASS) + joint(), 1),
    'fixed link without mass': (link() + link('b', NO_MASS) + joint('fixed'), 0),
    'unphysical inertia': (link('a', BODY.replace('ixx="0.1"', 'ixx="0.5"')), 1),
    'one moment of zero': (link('a', BODY.replace('ixx="0.1"', 'ixx="0"')), 1),
    'floating joint': (TWO + joint('floating'), 1),
    'planar joint': (TWO + joint('planar'), 1),
    'mimic, safety, calibration': (
        TWO
        + joint(
            'revolute',
            """
        <limit lower="-1" upper="1" effort="10" velocity="1"/><mimic joint="x" multiplier="-1"/>
        <safety_controller k_velocity="10"/><calibration rising="0.0"/>""",
        ),
        0,
    ),
    'limits crossed': (
        TWO + joint('revolute', '<limit lower="0.1" upper="-0.1" effort="0" velocity="0"/>'),
        1,
    ),
    'infinite limits': (
        TWO + joint('revolute', '<limit lower="-inf" upper="INF" effort="inf" velocity="1e30"/>'),
        0,
    ),
    'negative damping': (TWO + joint(inside='<dynamics damping="-0.1"/>'), 1),
    'transmission': (
        TWO + joint() + '<transmission name="t"><joint name="to_b"/></transmission>',
        0,
    ),
    'material twice': (
        2 * '<material name="m"><color rgba="1 0 0 1"/></material>'
        + look(more='<material name="m"/>'),
        0,
    ),
    'undefined material': (look(more='<material name="m"/>'), 1),
    'colour of three numbers': (
        look(more='<material name="m"><color rgba="1 0 0"/></material>'),
        1,
    ),
    'mesh of a Windows path': (look(r'<mesh filename="C:\meshes\m.STL"/>'), 1),
    'mesh of a relative path': (look('<mesh filename="../meshes/m.DAE"/>'), 1),
    'mesh of no size': (look('<mesh filename="/m.dae" scale="1 0 0"/>'), 1),
    'collision of no size': (
        link('a', f'{BODY}<collision><geometry><box size="0 0 0"/></geometry></collision>'),
        1,
    ),
    'block of a missing link': (link() + gazebo('<mu1>1</mu1>', 'b')[len(link()) :], 1),
    'empty blocks': (link() + '<gazebo/><gazebo reference="a"/>', 0),
    'numbers in any form': (
        gazebo('<mu1 value="0.5"/><mu2> .5 </mu2><kp>1e+6</kp><kd>1.\n</kd>'),
        0,
    ),
    'text behind a number': (gazebo('<mu1>0.5;</mu1>'), 1),
    'booleans in any form': (
        gazebo('<turnGravityOff>FALSE</turnGravityOff><selfCollide>True</selfCollide>'),
        0,
    ),
    'material of a script that Gazebo lacks': (gazebo('<material>Robot/Paint</material>'), 1),
    'sensors': (
        gazebo(
            '<sensor type="ray" name="s">' + PLUGIN.format('libgazebo_ros_laser.so') + '</sensor>'
        ),
        1,
    ),
    'unavailable plugins': (
        link() + f'<gazebo>{PLUGIN.format("libgazebo_ros_elevator.so")}</gazebo>'
        f'<gazebo>{PLUGIN.format("libmine.so")}<plugin name="x"/></gazebo>',
        3,
    ),
    'names of any kind': (
        TWO.replace('"a"', '"my base/link"') + joint().replace('"a"', '"my base/link"'),
        0,
    ),
    'tags of other languages': ('<xacro:property name="x" value="1"/><sensor:ray/>' + link(), 2),
    'obsolete collision settings': (
        link('a', BODY.replace('</collision>', '<contact_coefficients mu="0"/></collision>')),
        0,
    ),
}


@pytest.fixture(scope='module')
def world():
    with empty_world() as made:
        yield made


@pytest.mark.parametrize('name', ROBOTS)
def test_irregular_robot_stands_and_each_irregularity_is_logged_once(name, world, caplog):
    body, lines = ROBOTS[name]
    spec, _ = load_urdf(f'<robot name="r">{body}</robot>', 'bot')
    model = world.spawn(spec, 'bot', Pose((0.0, 0.0, DROP)))
    world.run(STEPS)
    x, y, z = model.links[spec.links[0].name].pose.position
    world.delete('bot')
    assert abs(x) < THICK and abs(y) < THICK
    assert LOWEST < z < HIGHEST
    assert len(caplog.records) == lines, caplog.messages


SHAPE = f'<geometry><box><size>0.4 0.3 {THICK}</size></box></geometry>'
MODEL = f'<link name="a"><collision name="c">{SHAPE}</collision></link>'
MESH = (
    '<link name="b"><visual name="v"><geometry><mesh><uri>{}</uri></mesh></geometry></visual>'
    '</link>'
)
MODELS = {
    'no version': (MODEL, '', 1),
    'oldest version': (MODEL, ' version="1.3"', 0),
    'newer version': (MODEL, ' version="1.9"', 1),
    'pose of three numbers': (f'<pose>0 0 0</pose>{MODEL}', ' version="1.5"', 1),
    'old frame attribute': (
        MODEL.replace('<collision', '<pose frame="">0 0 0 0 0 0</pose><collision'),
        ' version="1.6"',
        0,
    ),
    'missing model': (f'{MODEL}<include><uri>model://hokuyo</uri></include>', ' version="1.4"', 1),
    'missing package': (MODEL + MESH.format('package://nowhere/m.dae'), ' version="1.4"', 1),
    'model path of three slashes': (
        MODEL + MESH.format('model:///nowhere/m.dae'),
        ' version="1.4"',
        1,
    ),
    'joint to a missing link': (
        f'{MODEL}<joint name="j" type="fixed"><parent>a</parent><child>x</child></joint>',
        ' version="1.6"',
        1,
    ),
}


@pytest.mark.parametrize('name', MODELS)
def test_irregular_model_stands_and_each_irregularity_is_logged_once(name, world, caplog):
    body, version, lines = MODELS[name]
    spec, _ = load_sdf(
        f'<sdf{version}><model name="m">{body}</model></sdf>',
        'bot',
        find_model=ModelSearch(),
        find_package={}.get,
    )
    model = world.spawn(spec, 'bot', Pose((0.0, 0.0, DROP)))
    world.run(STEPS)
    assert LOWEST < model.links['a'].pose.position[2] < HIGHEST
    world.delete('bot')
    assert len(caplog.records) == lines, caplog.messages
