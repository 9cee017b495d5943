"""The launch files of gazebo_ros take the arguments that Gazebo's take, with the same defaults."""

from xml.etree import ElementTree

import pytest
from support import ROOT

LAUNCH = ROOT / 'companions' / 'gazebo_ros' / 'launch'

_COMMON = {
    'paused': 'false',
    'use_sim_time': 'true',
    'extra_gazebo_args': ' ',  # empty there, which the help of roslaunch calls required
    'gui': 'true',
    'debug': 'false',
    'physics': 'ode',
    'output': 'screen',
}
_EMPTY = _COMMON | {
    'recording': 'false',
    'headless': 'false',
    'verbose': 'false',
    'world_name': 'worlds/empty.world',
    'respawn_gazebo': 'false',
    'use_clock_frequency': 'false',
    'pub_clock_frequency': '100',
    'enable_ros_network': 'true',
    'server_required': 'false',
    'gui_required': 'false',
}
# The launch files of gazebo_ros 2.9.2: each argument with its default.
ARGUMENTS = {
    'empty_world': _EMPTY,
    'elevator_world': _COMMON
    | {
        'recording': 'false',
        'headless': 'false',
        'verbose': 'true',
        'world_name': 'worlds/elevator_ros.world',
    },
    'range_world': _COMMON | {'verbose': 'true', 'world': 'gazebo_ros_range'},
    'mud_world': {},
    'rubble_world': {},
    'shapes_world': {},
    'willowgarage_world': {},
}
# Ours, of every launch file.
WEB = {
    'web': 'false',
    'web_host': '127.0.0.1',
    'web_port': '8080',
    'web_open': 'true',
    'web_token': 'true',
    'web_max_viewers': '16',
}
HANDED_ON = {name: f'$(arg {name})' for name in WEB}
FIXED = {
    'paused': 'false',
    'use_sim_time': 'true',
    'gui': 'true',
    'headless': 'false',
    'recording': 'false',
    'debug': 'false',
}


def root(name: str) -> ElementTree.Element:
    return ElementTree.parse(LAUNCH / f'{name}.launch').getroot()


def test_every_launch_file_of_gazebo_is_there_and_no_other():
    assert {path.stem for path in LAUNCH.glob('*')} == set(ARGUMENTS)


@pytest.mark.parametrize('name', ARGUMENTS)
def test_arguments_and_defaults_are_those_of_gazebo_and_of_the_browser(name):
    found = {arg.get('name'): arg.get('default') for arg in root(name).findall('arg')}
    assert found == ARGUMENTS[name] | WEB


@pytest.mark.parametrize('name', [name for name, taken in ARGUMENTS.items() if not taken])
def test_launch_file_without_arguments_of_gazebo_passes_fixed_ones(name):
    (include,) = root(name).findall('include')
    assert include.get('file') == '$(dirname)/empty_world.launch'
    given = {arg.get('name'): arg.get('value') for arg in include.findall('arg')}
    world = f'worlds/{name.removesuffix("_world")}.world'
    assert given == FIXED | HANDED_ON | {'world_name': world}


def test_range_world_passes_every_argument():
    (include,) = root('range_world').findall('include')
    given = {arg.get('name'): arg.get('value') for arg in include.findall('arg')}
    world = given.pop('world_name')
    assert world == '$(find gazebo_plugins)/test/test_worlds/$(arg world).world'
    assert given == HANDED_ON | {
        name: f'$(arg {name})' for name in ARGUMENTS['range_world'] if name != 'world'
    }


@pytest.mark.parametrize('name', ['empty_world', 'elevator_world'])
def test_nodes_have_gazebos_names(name):
    nodes = [(node.get('name'), node.get('pkg')) for node in root(name).findall('node')]
    assert nodes == [
        ('gazebo', 'gazebo_ros'),
        ('gazebo_gui', 'gazebo_ros'),
        ('gzweb', 'gazebo_ros'),
    ]
