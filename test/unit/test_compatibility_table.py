"""doc/gazebo_compatibility.md has exactly one row for each name that the code registers."""

from collections import Counter
from contextlib import closing
from types import SimpleNamespace
from xml.etree import ElementTree

import pytest
import rospy
from support import ROOT
from support.compatibility import rows

from rosbots_description.cli.gz import NOT_HERE, parser
from rosbots_description.ros_api.node import node
from rosbots_description.ros_api.node.packages import find_model, find_package
from rosbots_description.ros_api.node.world_loading import read_world
from rosbots_description.ros_api.reconfigure import physics
from rosbots_description.ros_api.server.loop import Loop
from rosbots_description.ros_api.server.server import Server
from rosbots_description.sim import controllers, plugins  # noqa: F401  plugins registers
from rosbots_description.sim.plugin_registry.gazebo_libraries import missing_libraries
from rosbots_description.sim.plugin_registry.registry import known_filenames
from rosbots_description.sim.runtime.world import World

TABLE = ROOT / 'doc' / 'gazebo_compatibility.md'
EMPTY_WORLD = ROOT / 'companions' / 'gazebo_ros' / 'launch' / 'empty_world.launch'
OFFERED = ('same', 'better', 'ours')
MISSING = 'not supported'
OF_EVERY_NODE = {'/gazebo/get_loggers', '/gazebo/set_logger_level'}  # rospy's own services


def table(section):
    """Return the state of each name in a section."""
    return {name: state for name, state, _ in rows(section)}


def offered(section):
    """Return the supported names of a section."""
    return {name for name, state in table(section).items() if state in OFFERED}


def global_name(name):
    return name.replace('~', '/gazebo/') if name.startswith('~') else name


@pytest.fixture(scope='module')
def registered():
    """Return the services, topics and parameters that the node uses in two steps."""
    names = {kind: set() for kind in ('services', 'topics', 'parameters')}

    def endpoint(kind):
        def make(name, *_arguments, **_options):
            names[kind].add(global_name(name))
            # every topic has subscribers, so that all of them are published
            return SimpleNamespace(publish=lambda _message: None, get_num_connections=lambda: 1)

        return make

    def parameter(name, default=None):
        names['parameters'].add(global_name(name))
        return True if default is False else default  # switches on all options

    world = World()
    with pytest.MonkeyPatch.context() as patch, closing(world):
        for name, kind in (
            ('Service', 'services'),
            ('Publisher', 'topics'),
            ('Subscriber', 'topics'),
        ):
            patch.setattr(rospy, name, endpoint(kind))
        for name in ('get_param', 'has_param', 'set_param'):
            patch.setattr(rospy, name, parameter)
        patch.setattr(
            physics, 'write_parameters', lambda values: [parameter(f'~{name}') for name in values]
        )
        loop = Loop(world)
        registrar = SimpleNamespace(post=loop.post)
        server = Server(world, loop, registrar, find_package, find_model, None)
        node._connect(server, read_world('worlds/empty.world'))
        loop.run(steps=2)
    return names


@pytest.mark.parametrize(
    'section',
    [
        'Services',
        'Topics',
        'Parameters',
        'Arguments of empty_world.launch',
        'Plugins',
        'Controllers',
        'Launch files and programs',
        'Commands of gz',
        'Paths and packages',
    ],
)
def test_each_name_has_one_row_with_a_known_state(section):
    counts = Counter(name for name, _, _ in rows(section))
    assert [name for name, count in counts.items() if count > 1] == []
    for name, state, how in rows(section):
        assert state in (*OFFERED, MISSING), name
        assert how or state == 'same', f'{name}: the remark is missing'


@pytest.mark.parametrize('section', ['Services', 'Topics', 'Parameters'])
def test_node_offers_exactly_what_its_table_lists(section, registered):
    found = registered[section.lower()]
    if section == 'Services':
        found = found | OF_EVERY_NODE
    assert found == offered(section)


def test_every_plugin_has_a_row_as_supported():
    assert set(known_filenames()) == offered('Plugins')


def test_every_type_of_controller_has_a_row():
    assert {name for name, _ in controllers.ControllerManager.types()} == offered('Controllers')


def test_every_known_but_unsupported_library_has_a_row():
    rows = table('Plugins')
    assert set(missing_libraries()) == {name for name, state in rows.items() if state == MISSING}


def test_every_argument_of_the_launch_file_has_a_row():
    arguments = {arg.get('name') for arg in ElementTree.parse(EMPTY_WORLD).getroot().iter('arg')}
    assert arguments == set(table('Arguments of empty_world.launch'))


def test_every_launch_file_and_program_of_gazebo_ros_has_a_row():
    folder = EMPTY_WORLD.parents[1]
    files = {path.name for path in [*folder.glob('launch/*.launch'), *folder.glob('scripts/*')]}
    assert files == set(table('Launch files and programs'))


def test_every_command_of_gz_has_a_row():
    rows = table('Commands of gz')
    commands = parser()._subparsers._group_actions[0].choices
    assert {f'gz {name}' for name in NOT_HERE} == {
        name for name, state in rows.items() if state == MISSING
    }
    assert {f'gz {name}' for name in commands} == offered('Commands of gz')
