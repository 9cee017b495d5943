"""Table and plot of speeds: estimates are called so."""

import sys
from types import ModuleType

import pytest
from support import ROOT


@pytest.fixture
def speed(monkeypatch):
    """Return the module, with stubs for the modules that start servers."""
    monkeypatch.syspath_prepend(str(ROOT / 'benchmark'))
    for name, members in (('server', ('Server', 'run_in_new_process')),
                          ('reader', ('PER_SECOND', 'Reader', 'robot_topics')),
                          ('loops', ('Loop',))):
        module = ModuleType(name)
        vars(module).update(dict.fromkeys(members))
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.delitem(sys.modules, 'speed', raising=False)
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
        speed, measured, monkeypatch, tmp_path):
    drawn = {}
    monkeypatch.setattr(speed, 'plot_speed', lambda path, curves, estimated: drawn.update(
        curves=curves, estimated=estimated))
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
