"""Launch files load without a master, document their arguments, and start the right nodes."""

import os
import re
import shlex
import signal
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
import yaml
from roslaunch.arg_dump import dump_args
from roslaunch.config import ROSLaunchConfig
from roslaunch.core import RLException
from roslaunch.xmlloader import XmlLoader
from support import ROOT
from support.programs import ran

from rosbots_description.cli.display import STARTS

NAVIGATION = ROOT / 'companions' / 'rosbots_navigation' / 'launch'
FILES = sorted([*ROOT.glob('launch/*.launch'), *ROOT.glob('companions/*/launch/*.launch')])


def name(path: Path) -> str:
    return str(path.relative_to(ROOT))


@pytest.fixture
def built(tmp_path):
    """Return a folder with manifests of the packages that ./rosbots navigation builds."""
    for package in yaml.safe_load((ROOT / 'tools/navigation/targets.yaml').read_text('utf-8')):
        folder = tmp_path / 'built' / package
        folder.mkdir(parents=True)
        (folder / 'package.xml').write_text(
            f'<package><name>{package}</name><version>1.2.3</version><description>x</description>'
            '<maintainer email="a@b.example">a</maintainer><license>BSD</license></package>'
        )
    return tmp_path / 'built'


run_command = XmlLoader.param_value
EXPANDED = {}  # descriptions, by what they are read from


def param_value(loader, verbose, name, ptype, *source):
    """Return the value of a parameter; xacro runs once for each of its commands in all tests."""
    if not name.endswith('_description'):
        return run_command(loader, verbose, name, ptype, *source)
    if source not in EXPANDED:
        EXPANDED[source] = run_command(loader, verbose, name, ptype, *source)
    return EXPANDED[source]


@pytest.fixture
def load(monkeypatch, built):
    """Return a function (file name in launch/ or path, arguments) -> ROSLaunchConfig."""
    places = [
        str(ROOT),
        str(ROOT / 'companions'),
        str(built),
        os.environ.get('ROS_PACKAGE_PATH', ''),
    ]
    monkeypatch.setenv('ROS_PACKAGE_PATH', os.pathsep.join(filter(None, places)))
    # `env python3` of the xacro script must be the interpreter that runs the tests
    interpreter = str(Path(sys.executable).parent)
    monkeypatch.setenv('PATH', os.pathsep.join([interpreter, os.environ['PATH']]))
    monkeypatch.setattr('roslaunch.substitution_args._rospack', None)  # it caches the path
    monkeypatch.setenv('ROS_MASTER_URI', 'http://localhost:1')
    monkeypatch.setattr(XmlLoader, 'param_value', param_value)

    def load_file(path, *arguments):
        config = ROSLaunchConfig()
        XmlLoader(resolve_anon=False).load(
            str(ROOT / 'launch' / path), config, verbose=False, argv=list(arguments)
        )
        assert config.config_errors == []
        return config

    return load_file


def nodes(config) -> dict:
    return {node.name: f'{node.package}/{node.type}' for node in config.nodes}


def arguments(config, node_name: str) -> str:
    """Return a node's arguments with single blanks between them."""
    text = next(node.args for node in config.nodes if node.name == node_name)
    return ' '.join(text.split())


def test_there_are_launch_files():
    assert {'load_description', 'rviz', 'simulation', 'spawn'} <= {path.stem for path in FILES}


def test_roslaunch_finds_each_file_once():
    for path in ROOT.glob('launch/*.launch'):  # it searches the whole package
        assert list(ROOT.glob(f'[!.]*/**/{path.name}')) == [path]


@pytest.mark.parametrize('path', FILES, ids=name)
def test_launch_file_loads(load, path):
    load(path)


@pytest.mark.parametrize('path', FILES, ids=name)
def test_every_argument_is_documented(path):
    silent = [
        arg.get('name')
        for arg in ElementTree.parse(path).getroot().findall('arg')
        if not (arg.get('doc') or '').strip()
    ]
    assert silent == []


@pytest.mark.parametrize('path', FILES, ids=name)
def test_no_argument_is_required(load, capsys, path):
    dump_args([str(path)])
    assert 'Required' not in capsys.readouterr().out


def test_load_description_starts_nothing(load):
    config = load('load_description.launch')
    assert config.nodes == []
    assert 'name="rosbots"' in config.params['/robot_description'].value


def test_load_description_takes_a_path_with_blanks(load, tmp_path):
    path = tmp_path / 'my robot.urdf'
    path.write_text('<robot name="mine"><link name="base"/></robot>', encoding='utf-8')
    config = load('load_description.launch', f'model:={path}')
    assert '<robot name="mine">' in config.params['/robot_description'].value


def test_rviz_shows_the_robot(load):
    assert nodes(load('rviz.launch')) == {
        'joint_state_publisher': 'joint_state_publisher/joint_state_publisher',
        'robot_state_publisher': 'robot_state_publisher/robot_state_publisher',
        'rviz': 'rviz/rviz',
    }


@pytest.mark.parametrize('path', FILES, ids=name)
def test_windows_are_opened_only_where_there_is_a_display(path):
    for node in ElementTree.parse(path).iter('node'):
        if node.get('type') in ('rviz', 'joint_state_publisher_gui'):
            (prefix,) = shlex.split(node.get('launch-prefix'))
            assert prefix.endswith('/with_display'), prefix


def test_without_a_display_a_sentence_takes_the_place_of_a_window():
    environment = {**os.environ, 'DISPLAY': ':987654'}
    done = ran(ROOT / 'launch' / 'with_display', 'echo', 'started', env=environment)
    assert (done.returncode, done.stdout) == (0, '')
    assert done.stderr == (
        'echo: no window: there is no display to open it on (DISPLAY is :987654)\n'
    )


def test_with_a_display_a_window_that_crashes_as_it_opens_is_restarted():
    script = str(ROOT / 'launch' / 'with_display')
    with_a_display = (
        'import runpy, sys; from rosbots_simulator.cli import display; '
        'display.display_works = lambda: True; '
        "sys.argv[1:] = ['sh', '-c', 'echo started; kill -SEGV $$']; "
        f"runpy.run_path({script!r}, run_name='__main__')"
    )
    done = ran(sys.executable, '-c', with_a_display)
    assert (done.returncode, done.stdout) == (128 + signal.SIGSEGV, 'started\n' * STARTS)
    assert done.stderr.startswith('sh: crashed as it opened (SIGSEGV); restarting it\n')


def test_rviz_and_sliders_are_optional(load):
    assert set(nodes(load('rviz.launch', 'rviz:=false', 'gui:=true'))) == {
        'joint_state_publisher_gui',
        'robot_state_publisher',
    }


def test_rviz_config_shows_the_robot_in_base_link():
    text = (ROOT / 'config' / 'rosbots.rviz').read_text(encoding='utf-8')
    assert 'Fixed Frame: base_link' in text
    assert 'Class: rviz/RobotModel' in text


def test_spawn_calls_spawn_model_as_the_article_does(load):
    config = load('spawn.launch')
    assert nodes(config) == {'mybot_spawn': 'gazebo_ros/spawn_model'}
    assert config.nodes[0].output == 'screen'
    assert arguments(config, 'mybot_spawn') == (
        '-urdf -param robot_description -model rosbots -x 0 -y 0 -z 0.5 -R 0 -P 0 -Y 0'
    )
    assert '<robotBaseFrame>base_link<' in config.params['/robot_description'].value


@pytest.mark.parametrize('file', ['load_description', 'rviz', 'spawn', 'simulation'])
def test_robot_has_the_requested_sensors(load, file):
    switches = [f'{name}:=true' for name in ('depth', 'imu', 'laser', 'bumper', 'surfaces')]
    text = (
        load(f'{file}.launch', 'camera:=true', 'camera_pitch:=0.5', *switches)
        .params['/robot_description']
        .value
    )
    assert re.findall('<sensor name=".*" type="(.*)"', text) == ['depth', 'imu', 'ray', 'contact']
    assert 'rpy="0 0.5 0"' in text
    assert '<kp>' in text


def test_each_argument_goes_to_the_one_of_its_name():
    text = (ROOT / 'launch' / 'load_description.launch').read_text(encoding='utf-8')
    passed = re.findall(r'(\w+):=\$\(arg (\w+)\)', text)
    assert [name for name, _ in passed] == [name for _, name in passed]
    assert {name for name, _ in passed} | {'model'} == set(re.findall('<arg name="([^"]+)"', text))


def test_spawn_passes_every_argument_on(load):
    config = load(
        'spawn.launch',
        'x:=-1.5',
        'y:=2',
        'z:=0.1',
        'roll:=0.1',
        'pitch:=-0.2',
        'yaw:=-3',
        'model_name:=other',
        'robot_namespace:=/r1',
    )
    assert arguments(config, 'mybot_spawn') == (
        '-urdf -param robot_description -model other -x -1.5 -y 2 -z 0.1 -R 0.1 -P -0.2 -Y -3'
        ' -robot_namespace /r1'
    )


def test_simulation_has_one_tf_tree_and_rviz_is_optional(load):
    config = load('simulation.launch', 'gui:=false', 'x:=-1')
    assert {'gazebo', 'mybot_spawn', 'robot_state_publisher'} == set(nodes(config))
    assert '<robotBaseFrame>base_footprint<' in config.params['/robot_description'].value
    assert ' -x -1 ' in arguments(config, 'mybot_spawn')
    assert 'rviz' in nodes(load('simulation.launch', 'rviz:=true'))


def test_see_shows_the_data_of_all_sensors(load):
    config = load('see.launch')
    assert set(nodes(config)) == {'gazebo', 'mybot_spawn', 'robot_state_publisher', 'rviz'}
    assert arguments(config, 'gazebo').endswith(' "worlds/rooms.world"')
    description = config.params['/robot_description'].value
    assert re.findall('<sensor name=".*" type="(.*)"', description) == [
        'depth',
        'imu',
        'ray',
        'contact',
    ]
    file = Path(arguments(config, 'rviz').split("'")[1])
    view = yaml.safe_load(file.read_text(encoding='utf-8'))['Visualization Manager']
    topics = {
        display['Class']: display.get('Topic', display.get('Image Topic'))
        for display in view['Displays']
    }
    assert topics == dict.fromkeys(['rviz/Grid', 'rviz/RobotModel', 'rviz/TF']) | {
        'rviz/LaserScan': 'scan',
        'rviz/PointCloud2': 'camera1/depth/points',
        'rviz/Image': 'camera1/image_raw',
    }


@pytest.mark.parametrize(
    'file', ['simulation', *(path for path in FILES if path.stem.endswith('_world'))], ids=str
)
def test_each_world_can_be_seen_in_a_browser(load, file):
    file = f'{file}.launch' if isinstance(file, str) else file
    assert 'gzweb' not in nodes(load(file))
    config = load(file, 'web:=true', 'web_host:=0.0.0.0', 'web_port:=8081')
    assert arguments(config, 'gzweb') == ('--host 0.0.0.0 --port 8081 --max-viewers 16 --open')
    config = load(file, 'web:=true', 'web_open:=false', 'web_token:=false', 'web_max_viewers:=30')
    assert arguments(config, 'gzweb') == (
        '--host 127.0.0.1 --port 8080 --max-viewers 30 --no-token'
    )


def test_each_student_has_a_page_at_a_port_of_their_own(load):
    for student, port in ((1, 8101), (20, 8120)):
        config = load('student.launch', f'student:={student}')
        assert arguments(config, 'gzweb') == f'--host 127.0.0.1 --port {port} --max-viewers 16'
        assert 'gazebo_gui' not in nodes(config)


def test_simulation_passes_its_arguments_to_the_simulator(load):
    config = load(
        'simulation.launch', 'paused:=true', 'world_name:=my.world', 'use_sim_time:=false'
    )
    assert arguments(config, 'gazebo').startswith('-u ')
    assert arguments(config, 'gazebo').endswith(' "my.world"')
    assert config.params['/use_sim_time'].value is False


GMAPPING = {'slam_gmapping': 'gmapping/slam_gmapping'}
MOVE_BASE = {'move_base': 'move_base/move_base'}
SIMULATION = {
    'gazebo': 'gazebo_ros/gzserver',
    'mybot_spawn': 'gazebo_ros/spawn_model',
    'robot_state_publisher': 'robot_state_publisher/robot_state_publisher',
}


@pytest.mark.parametrize(
    ('file', 'arguments', 'started'),
    [
        ('mapping', ['rviz:=false'], SIMULATION | GMAPPING),
        (
            'mapping',
            ['simulation:=false', 'wander:=true'],
            GMAPPING | {'wander': 'rosbots_description/wander.py', 'rviz': 'rviz/rviz'},
        ),
        ('save_map', [], {'map_saver': 'map_server/map_saver'}),
        (
            'navigation',
            ['simulation:=false'],
            MOVE_BASE
            | {'map_server': 'map_server/map_server', 'amcl': 'amcl/amcl', 'rviz': 'rviz/rviz'},
        ),
        ('slam_navigation', ['rviz:=false'], SIMULATION | GMAPPING | MOVE_BASE),
    ],
)
def test_navigation_starts_what_it_says(load, file, arguments, started):
    config = load(NAVIGATION / f'{file}.launch', *arguments)
    assert nodes(config) == started
    if 'gazebo' in started:
        assert '<sensor name="laser" type="ray"' in config.params['/robot_description'].value


def test_versions_of_what_is_built_are_a_parameter(load):
    config = load(NAVIGATION / 'navigation.launch')
    assert config.params['/rosbots_navigation/navigation'].value.strip() == (
        'map_server 1.2.3, amcl 1.2.3, move_base 1.2.3, dwa_local_planner 1.2.3'
    )


def test_map_and_initial_pose_of_navigation_are_arguments(load):
    config = load(NAVIGATION / 'navigation.launch', 'map:=/my maps/a.yaml', 'initial_yaw:=1.5')
    assert arguments(config, 'map_server') == "'/my maps/a.yaml'"
    assert config.params['/amcl/initial_pose_a'].value == 1.5
    default = load(NAVIGATION / 'navigation.launch')
    assert Path(arguments(default, 'map_server').strip("'")).resolve() == (
        NAVIGATION.parent / 'maps' / 'rooms.yaml'
    )


def test_map_is_saved_where_the_terminal_is(load, monkeypatch):
    monkeypatch.setenv('PWD', '/home/me')
    assert arguments(load(NAVIGATION / 'save_map.launch'), 'map_saver') == "-f '/home/me/map'"


@pytest.mark.parametrize('file', ['mapping', 'navigation', 'save_map', 'slam_navigation'])
def test_navigation_that_is_not_built_starts_nothing(load, built, capfd, file):
    for manifest in built.rglob('package.xml'):
        manifest.unlink()
    with pytest.raises(RLException, match='require_packages'):
        load(NAVIGATION / f'{file}.launch')
    assert capfd.readouterr().err.endswith('run: ./rosbots navigation\n')


EXAMPLES = ['follow_policy', 'go_to_goal', 'line_follower', 'map_while_driving', 'wander']


@pytest.mark.parametrize('name', EXAMPLES)
def test_an_example_node_gets_the_parameters_that_it_reads(load, name):
    script = (ROOT / 'scripts' / f'{name}.py').read_text(encoding='utf-8')
    config = load(f'{name}.launch', 'simulation:=false')
    given = {
        param.removeprefix(f'/{name}/'): value.value
        for param, value in config.params.items()
        if param.startswith(f'/{name}/')
    }
    defaults = {
        param: yaml.safe_load(default)
        for param, default in re.findall(r"get_param\('~(\w+)', ([^)]*)\)", script)
    }
    required = set(re.findall(r"get_param\('~(\w+)'\)", script))
    assert given == defaults | {param: given[param] for param in required}
    documented = script.split('Parameters:')[1].split('"""')[0]
    assert set(re.findall(r'~(\w+)', documented)) == set(given)


@pytest.mark.parametrize('name', EXAMPLES)
def test_an_example_runs_beside_a_simulator_and_drives_the_robot(load, name):
    example = load(f'{name}.launch', 'simulation:=false', 'rviz:=false')
    drivers = [node for node in example.nodes if node.name != 'map_while_driving']
    assert {node.package for node in example.nodes} == {'rosbots_description'}
    assert [tuple(node.remap_args[0]) for node in drivers] == [('cmd_vel', '/part2_cmr/cmd_vel')]


@pytest.mark.parametrize('file', ['empty_world', 'elevator_world'])
@pytest.mark.parametrize(
    ('world', 'words'),
    [
        ("/home/me/Mein Roboter ä/o'clock #1.world", ["/home/me/Mein Roboter ä/o'clock #1.world"]),
        ('', []),
    ],
)
def test_a_world_with_blanks_in_its_path_is_one_argument(load, tmp_path, file, world, words):
    path = tmp_path / 'including.launch'
    path.write_text(
        f'<launch><include file="$(find gazebo_ros)/launch/{file}.launch">'
        f'<arg name="world_name" value="{world}"/></include></launch>',
        encoding='utf-8',
    )
    server = next(node for node in load(path).nodes if node.name == 'gazebo')
    assert [word for word in shlex.split(server.args) if '.world' in word or not word] == words
