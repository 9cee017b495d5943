"""Tables and plot of speeds: estimates are called so, the slowest command is the headline."""

import sys
from types import ModuleType

import pytest
from support import ROOT


@pytest.fixture
def speed(monkeypatch):
    """Return the module, with stubs for the modules that start servers."""
    monkeypatch.syspath_prepend(str(ROOT / 'benchmark'))
    for name, members in (
        ('server', ('Server', 'run_in_new_process', 'STEPS_PER_SECOND')),
        ('reader', ('PER_SECOND', 'Reader', 'robot_topics')),
        ('loops', ('Loop',)),
    ):
        module = ModuleType(name)
        vars(module).update(dict.fromkeys(members, 1000.0))
        monkeypatch.setitem(sys.modules, name, module)
    for name in ('speed', 'sweep'):
        monkeypatch.delitem(sys.modules, name, raising=False)
    import speed

    return speed


@pytest.fixture
def measured(speed):
    """Return cases in which every loop runs 1000 steps per second."""
    cases = speed.cases()
    for case in cases:
        for column in speed.COLUMNS:
            case.record(column, 1000.0)
    return cases


def test_plot_labels_gazebos_curve_an_estimate_with_standing_robots(
    speed, measured, monkeypatch, tmp_path
):
    drawn = {}
    monkeypatch.setattr(
        speed,
        'plot_speed',
        lambda path, curves, estimated: drawn.update(curves=curves, estimated=estimated),
    )
    speed.draw(measured, tmp_path / 'speed.png')
    label = drawn['estimated']
    assert label in drawn['curves']
    assert label.startswith('Gazebo, no subscriber: estimated')
    assert 'from 5 robots on, these stand' in label
    assert [robots for robots, _ in drawn['curves'][label]] == [1, 5, 10, 20]


def test_plot_is_written_as_png(speed, measured, tmp_path):
    speed.draw(measured, tmp_path / 'speed.png')
    assert (tmp_path / 'speed.png').read_bytes().startswith(b'\x89PNG')


def test_table_calls_gazebos_speeds_estimated(speed, measured):
    assert 'not measured here but estimated' in speed.table(measured)


def test_parts_of_a_step_add_up_and_have_the_limit_beside_them(speed):
    case = speed.Case(1, True)
    loops = {'merged': 5e4, 'engine': 2e5, 'world': 1e5, 'server': 5e4, 'read': 4e4}
    for column, steps in loops.items():
        case.record(column, steps)
    row = speed.parts_table([case]).splitlines()[-1]
    assert row.split() == ['1', 'driving', '5.0', '5.0', '10.0', '5.0', '25.0', '1.00']


def test_the_slowest_command_of_each_kind_is_the_headline(speed):
    import sweep

    points = [
        sweep.Swept(kind, robots, command, (one - 0.1, one, one + 5.0), 1e4, 0.5)
        for kind in sweep.KINDS
        for robots in sweep.TARGETS
        for command, one in zip(sweep.COMMANDS, range(9, 0, -1), strict=True)
    ]
    text = sweep.sweep_table(points)
    assert (
        'slowest command, 20 skid steer of four: 1.00 times Gazebo at (0 m/s, 1 rad/s) (NOT met: 4)'
    ) in text
    assert text.count('slowest command') == 6
    assert 'Gazebo: estimated' in text


def test_the_sweep_has_nine_commands_for_three_kinds(speed):
    import sweep

    assert len(set(sweep.COMMANDS)) == 9
    assert {speed for speed, turning in sweep.COMMANDS if not turning} == {0.05, 0.1, 0.3, 0.5, 1.0}
    assert len(sweep.KINDS) == 3
