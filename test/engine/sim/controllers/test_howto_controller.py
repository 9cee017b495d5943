"""The controller and the robot of doc/howto_add_a_controller.md run as printed."""

import re
import sys

import pytest
import yaml
from support import ROOT
from support.controllers import spawn_arm, start_controller
from support.programs import lint_faults

from rosbots_description.sim import World
from rosbots_description.sim.controllers import ControllerError
from rosbots_description.sim.controllers import registry as types
from rosbots_description.sim.formats import expand_xacro

TEXT = (ROOT / 'doc' / 'howto_add_a_controller.md').read_text(encoding='utf-8')
(CODE,) = re.findall(r'```python\n# \S+\n(.*?)```', TEXT, re.DOTALL)
(TAGS,) = re.findall(r'```xml\n(.*?)```', TEXT, re.DOTALL)
WAVE, BASE = (yaml.safe_load(text) for text in re.findall(r'```yaml\n(.*?)```', TEXT, re.DOTALL))
PLUGIN = re.compile(r'<gazebo>(?:(?!</gazebo>).)*libgazebo_ros_diff_drive.*?</gazebo>', re.DOTALL)
MOST_LINES = 60


@pytest.fixture
def package(monkeypatch, tmp_path):
    """Return the folder of an empty Python package my_robot on the path."""
    monkeypatch.setattr(types, '_TYPES', dict(types._TYPES))
    monkeypatch.syspath_prepend(tmp_path)
    folder = tmp_path / 'my_robot'
    folder.mkdir()
    (folder / '__init__.py').touch()
    yield folder
    for name in [
        name for name in sys.modules if name.partition('.')[0] in ('my_robot', 'rosbots_simulator')
    ]:
        del sys.modules[name]


def test_the_controller_is_short_and_lint_clean():
    assert CODE.count('\n') < MOST_LINES
    assert not lint_faults(CODE, 'controllers.py')


@pytest.mark.parametrize('own', ['rosbots_description', 'rosbots_simulator'])
def test_the_controller_is_found_by_its_type_and_waves(own, package, world):
    """It may import the simulator by either name: a server has the second one."""
    (package / 'controllers.py').write_text(
        CODE.replace('rosbots_description', own), encoding='utf-8'
    )
    model, _ = spawn_arm(world)
    parameters = WAVE['wave'] | {'joint': 'joint1'}
    wave, positions = start_controller(model, 'wave', parameters['type'], parameters), []
    assert list(wave.pids) == ['pid']
    world.run(2000)
    for _ in range(1000):
        world.step()
        positions.append(model.joint('joint1').position)
    middle = (max(positions) + min(positions)) / 2.0
    assert max(positions) - min(positions) == pytest.approx(2.0 * 0.2, rel=0.25)
    wave.command(middle + 0.5)
    world.run(3000)
    assert model.joint('joint1').position > middle + 0.2


def test_a_module_that_fails_is_named_and_the_world_lives_on(package, world):
    (package / 'controllers.py').write_text('raise RuntimeError("no such motor")\n')
    _, manager = spawn_arm(world)
    with pytest.raises(
        ControllerError,
        match=r"Could not load class 'my_robot/Wave': RuntimeError "
        r'in my_robot\.controllers: no such motor',
    ):
        manager.load('wave', 'my_robot/Wave', {})
    world.run(10)


@pytest.mark.parametrize(
    'name',
    [
        'my_robot/Wave',
        'json/Decoder',
        'no.such/Type',
        '../etc/passwd',
        '/',
        'a',
        'rosbots_description/X',
    ],
)
def test_nothing_is_imported_for_a_package_without_controllers(name, package, world):
    _, manager = spawn_arm(world)
    before = set(sys.modules)
    with pytest.raises(ControllerError, match='does not exist'):
        manager.load('c', name, {})
    assert set(sys.modules) == before


def test_the_robot_of_the_demo_drives_alike_by_the_controller(world):
    text = expand_xacro(str(ROOT / 'urdf' / 'rosbots.xacro'), {}, lambda _name: str(ROOT))
    changed, count = PLUGIN.subn(lambda _match: TAGS, text)
    assert count == 1
    motions = []
    for urdf in (text, changed):
        with World.empty() as other:
            robot = other.spawn(urdf, name='bot', z=0.5)
            other.run(1000)
            if urdf is changed:
                drive = start_controller(robot, 'base', BASE['base']['type'], BASE['base'])
            else:
                drive = robot.plugin('diff_drive')
            for _ in range(40):
                drive.command(0.4, 0.2)
                other.run(100)
            (x, y, _), turn = robot.twist
            motions.append(((x * x + y * y) ** 0.5, turn[2]))
    assert motions[1] == pytest.approx(motions[0], rel=0.02)
