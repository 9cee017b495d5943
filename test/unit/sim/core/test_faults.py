"""Faults: each once with its fields, bounded, handed to a callback that cannot hurt the world."""

import logging
import pickle
from dataclasses import replace

import pytest
from support.fake_engine import FakeEngine

from rosbots_description.sim import plugins, sensors  # noqa: F401  register
from rosbots_description.sim.core import MOST_FAULTS, Fault, Faults, SimClock, report, reporting_to
from rosbots_description.sim.core.transforms import IDENTITY
from rosbots_description.sim.formats import load_sdf, load_urdf
from rosbots_description.sim.formats.sdf.world_file import load_world
from rosbots_description.sim.resources import ModelSearch
from rosbots_description.sim.runtime import Hook, World, populate

URDF = """<robot name="r">
  <link name="base"><visual><geometry><sphere radius="1"/></geometry>
    <material name="paint"/></visual><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="tip"/>
  <joint name="j" type="continuous"><parent link="base"/><child link="tip"/>
    <axis xyz="0 0 0"/></joint>
</robot>"""


def sdf(inside):
    return f'<sdf version="1.6"><model name="own"><link name="a">\n{inside}</link>\n</model></sdf>'


def reported(read):
    """Return the faults that are reported in a call."""
    faults = []
    with reporting_to(faults.append):
        read()
    return faults


def loaded(inside, link=''):
    """Return the faults of a world with a model that has this in it."""
    text = (
        f'<sdf version="1.6"><model name="own"><link name="a">{link}</link>\n{inside}</model></sdf>'
    )
    world = World(make_engine=FakeEngine, on_fault=lambda fault: None)
    world.clock.steps = 7
    spec, _ = load_sdf(text, 'bot', find_model=ModelSearch())
    world.spawn(spec, 'bot', IDENTITY)
    return world.faults


@pytest.fixture
def faults():
    return Faults(SimClock(0.001), lambda fault: None)


def test_a_fault_of_a_urdf_says_where_it_is_and_what_helps():
    axis, colour, mass = reported(lambda: load_urdf(URDF, 'bot'))
    place = colour.model, colour.link, colour.element, colour.line
    assert place == ('bot', 'base', "material 'paint'", 3)
    assert colour.severity == logging.WARNING
    place = axis.model, axis.link, axis.element, axis.line
    assert place == ('bot', '', "joint 'j'", 7)
    assert axis.cure == 'write e.g. "0 0 1"'
    assert str(axis) == f'{axis.what}; {axis.cure}'
    assert axis.what.startswith("model 'bot' (robot_description): line 7: joint 'j': xyz=")
    assert (mass.model, mass.cure) == ('bot', 'give each an <inertial>')


def test_a_fault_of_an_sdf_says_where_it_is():
    text = sdf('<sensor name="s" type="ray"><update_rate>x</update_rate></sensor>')
    (fault,) = reported(lambda: load_sdf(text, 'bot', find_model=ModelSearch()))
    assert (fault.model, fault.link, fault.element, fault.line) == ('bot', 'a', "sensor 's'", 2)


def test_a_fault_of_a_world_file_names_the_model():
    text = (
        '<sdf version="1.6"><world name="w">\n<model name="m"><link name="a">'
        '<collision name="c"><geometry><sphere><radius>-1</radius></sphere></geometry></collision>'
        '</link></model></world></sdf>'
    )
    (fault,) = reported(lambda: load_world(text, 'w.world', find_model=ModelSearch()))
    assert (fault.severity, fault.model, fault.link, fault.line) == (logging.ERROR, 'm', 'a', 2)


def test_a_fault_while_a_plugin_loads_says_which_and_at_which_step():
    plugin = '<plugin name="drive" filename="libgazebo_ros_diff_drive.so">{}</plugin>'
    *warnings, error = loaded(plugin.format('<leftJoint>none</leftJoint><odd/>'))
    for fault in (*warnings, error):
        place = fault.model, fault.link, fault.element, fault.line, fault.step
        assert place == ('bot', '', "plugin 'drive'", 2, 7)
    assert {fault.severity for fault in warnings} == {logging.WARNING}
    assert error.severity == logging.ERROR


def test_a_plugin_that_is_not_there_is_a_fault():
    (fault,) = loaded('<plugin name="odd" filename="libodd.so"/>')
    place = fault.model, fault.element, fault.line
    assert place == ('bot', "plugin 'libodd.so'", 2)
    assert fault.cure.startswith('see ')


def test_a_fault_of_a_sensor_names_its_link():
    (fault,) = loaded('', '<sensor name="s" type="sonar"/>')
    assert (fault.model, fault.link, fault.element) == ('bot', 'a', "sonar 's'")


def test_what_a_world_cannot_take_is_among_its_faults():
    world = World(make_engine=FakeEngine, on_fault=lambda fault: None)
    text = (
        '<sdf version="1.6"><world name="w"><plugin name="p" filename="libp.so"/>'
        '<state world_name="w"><model name="gone"><pose>0 0 0 0 0 0</pose></model></state>'
        '</world></sdf>'
    )
    populate(world, load_world(text, 'w.world', find_model=ModelSearch()))
    state, plugin = world.faults
    assert "'gone'" in state.what
    assert (plugin.element, plugin.line) == ("plugin 'p'", 1)


class Broken(Hook):
    """A hook that fails in every step."""

    due = 0

    def before_step(self):
        raise RuntimeError('out of order')


def test_a_hook_that_fails_is_an_internal_fault_with_its_first_step(caplog):
    world = World(make_engine=FakeEngine)
    world.schedule.add(Broken())
    world.run(2500)
    (fault,) = world.faults
    assert (fault.step, fault.internal, fault.severity) == (1, True, logging.ERROR)
    assert caplog.messages == [str(fault)] * 3  # it was suspended twice
    assert caplog.text.count('RuntimeError: out of order') == 3


def test_faults_are_frozen_and_cross_processes(faults):
    faults.report('bad', logging.ERROR, 'mend it', model='m', link='l', element='e', line=3)
    (fault,) = pickle.loads(pickle.dumps(tuple(faults)))
    assert fault == Fault('bad', logging.ERROR, 'm', 'l', 'e', 3, cure='mend it')
    with pytest.raises(AttributeError):
        fault.line = 4


def test_each_fault_is_kept_once_with_its_first_step_and_the_callback_gets_all():
    clock, got = SimClock(0.001), []
    faults = Faults(clock, got.append)
    for clock.steps in (5, 9):
        faults.report('bad', model='a')
        faults.report('bad', model='b')
    assert [(one.model, one.step) for one in faults] == [('a', 5), ('b', 5)]
    assert [(one.model, one.step) for one in got] == [('a', 5), ('b', 5), ('a', 9), ('b', 9)]


def test_the_oldest_faults_are_dropped_and_counted(faults):
    for number in range(MOST_FAULTS + 3):
        faults.report(str(number))
    assert (len(faults), faults.dropped) == (MOST_FAULTS, 3)
    assert (str(faults[0]), str(faults[-1])) == ('3', str(MOST_FAULTS + 2))


def test_an_exception_of_the_callback_does_not_hurt_the_world(caplog):
    def fail(fault):
        raise ZeroDivisionError

    world = World(make_engine=FakeEngine, on_fault=fail)
    world.schedule.add(Broken())
    assert world.run(10) == 10
    assert len(world.faults) == 1
    assert 'on_fault failed' in caplog.text


def test_without_a_callback_faults_are_logged(caplog):
    Faults(SimClock(0.001)).report('100 % bad', logging.ERROR, cure='mend it')
    assert caplog.record_tuples[0][1:] == (logging.ERROR, '100 % bad; mend it')


def test_what_is_less_than_a_warning_is_logged_only(faults, caplog):
    caplog.set_level(logging.DEBUG)
    faults.report('idle', logging.DEBUG)
    assert (caplog.messages, len(faults)) == (['idle'], 0)


def test_a_report_goes_to_the_innermost_receiver_and_takes_its_place():
    outer, inner = [], []
    with reporting_to(outer.append, model='m', line=3):
        with reporting_to(inner.append, link='l'):
            report(Fault('one'))
        report(Fault('two', model='other'))
    assert inner == [Fault('one', link='l')]
    assert outer == [Fault('two', model='other', line=3)]


def test_a_report_without_a_receiver_is_logged(caplog):
    report(Fault('lost'))
    assert caplog.messages == ['lost']


def test_a_slice_and_the_words_of_faults(faults):
    faults.report('one')
    faults.report('two')
    assert list(faults[1:]) == [replace(faults[1])]
    assert repr(faults) == "<Faults ['one', 'two']>"
