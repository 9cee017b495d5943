"""Table of environments' speeds: ratios and verdicts."""

import sys
from types import ModuleType

import pytest
from support import ROOT

SPEEDS = {
    kind: (speed / 2.0, speed, speed, 3.0 * speed)
    for kind, speed in {
        'goal': 250.0,
        'cores': 400.0,
        'vector': 450.0,
        'core': 240.0,
        'step': 125.0,
        'pause': 10.0,
        'reset': 400.0,
        'mujoco': 500.0,
        'wander': 200.0,
        'maze': 210.0,
        'line': 60.0,
        'goal_physics': 400.0,
        'goal_scan': 2000.0,
        'mujoco_physics': 800.0,
        'mujoco_scan': 8000.0,
    }.items()
}


@pytest.fixture
def table(monkeypatch):
    """Return the function, with stubs for the modules that start servers."""
    monkeypatch.syspath_prepend(str(ROOT / 'benchmark'))
    for name, members in (
        ('server', ('Server', 'run_in_new_process')),
        ('environments', ('EnvironmentLoop', 'cores')),
        ('article', ('robot_urdf',)),
    ):
        module = ModuleType(name)
        vars(module).update(dict.fromkeys(members))
        monkeypatch.setitem(sys.modules, name, module)
    vars(sys.modules['environments'])['PER_CORE'] = 4
    monkeypatch.delitem(sys.modules, 'gym', raising=False)
    import gym

    yield gym.table
    sys.modules.pop('gym')


@pytest.mark.parametrize(
    ('row', 'value', 'verdict'),
    [
        ('per core', '25.00', '(met: at least 20)'),
        ('/ the same task in MuJoCo', '0.50', '(NOT met: at least 0.6)'),
        ('100 steps of physics', '2.50', '1.25       2.00'),
        ('a scan of 361 rays', '0.50', '0.12       4.00'),
        ('the rest', '1.00', '0.62       1.60'),
        ('GoToGoal-v0, one process', '250.0', '25.0       125-750'),
        ('/ over ROS by unpause', '25.00', '(met: at least 20)'),
        ('/ over ROS by /gazebo/step', '2.00', ''),
        ('processes / linear', '0.80', '(NOT met: at least 0.9)'),
        ('make_vec / linear from one core', '0.94', '(met: at least 0.9)'),
        ('make_vec / linear from one process', '0.90', ''),
        ('reset', '2.50', '(NOT met: at most 2)'),
    ],
)
def test_ratios_are_of_one_process_and_targets_are_judged(table, row, value, verdict):
    (line,) = (line for line in table(SPEEDS, 2).splitlines() if line.startswith(row))
    assert line.split(value)[1].strip() == verdict


def test_real_time_is_ten_control_steps_per_second(table):
    lines = table(SPEEDS, 2).splitlines()
    (line,) = (line for line in lines if line.startswith('over ROS by unpause'))
    assert line.split()[-3:-1] == ['10.0', '1.0']
