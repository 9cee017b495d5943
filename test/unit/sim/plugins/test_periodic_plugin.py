"""Timing of plugins: rates, due steps, resets; outputs with several readers."""

from dataclasses import replace

import pytest
from support.fake_drive import fake_model, make_drive

from rosbots_description.sim.plugins.base import ModelPlugin, PeriodicPlugin
from rosbots_description.sim.runtime.scheduler import NEVER


class Watcher(PeriodicPlugin):
    """Reports the current step."""

    def load(self):
        self.set_rate(self.params.rate('rate', 0.0))
        self.steps, self.woken = self.output('steps', requested=False), 0

    def report(self):
        self.steps.send(self.world.clock.steps)

    def wake(self):
        self.woken += 1


class Exact(Watcher):
    """Starts a period without waiting for the end of the previous one."""

    strictly_after = False


class Rounded(Exact):
    """Starts each period in the step in which the previous one ended."""

    keeps_rate = False


class LaterRounded(Watcher):
    """Waits for the end of a period, and starts the next one then."""

    keeps_rate = False


class Actor(Watcher):
    """Acts, too."""

    def update(self, elapsed):
        self.elapsed = elapsed


class Counter(Watcher):
    """Counts steps while it has readers."""

    every_step = True
    count = 0

    def after_each_step(self, now_ns):
        self.count += 1


def make(cls, rate):
    return make_drive(cls, fake_model(), rate=rate)


def seen(plugin, steps):
    """Return the steps in which the plugin reports."""
    found = []
    plugin.steps.connect(found.append)
    plugin.world.run(steps)
    plugin.steps.disconnect(found.append)
    return found


@pytest.mark.parametrize(
    ('cls', 'rate', 'steps'),
    [
        (Watcher, '100', [11, 21, 31]),
        (LaterRounded, '20', [51, 102]),
        (Exact, '100', [10, 20, 30]),
        (Exact, '30', [34, 67, 100]),
        (Rounded, '30', [34, 68, 102]),
        (Exact, '0', [1, 2, 3]),
        (Watcher, '-1', [1, 2, 3]),
        (Exact, '2000', [1, 2, 3]),
    ],
)
def test_timing_is_that_of_gazebos_four_rules(cls, rate, steps):
    assert seen(make(cls, rate), 110)[:3] == steps[:3]


@pytest.mark.parametrize(
    ('cls', 'steps'),
    [
        (Watcher, [11, 21, 31]),
        (Exact, [10, 20, 30]),
        (Rounded, [17, 27, 37]),
    ],
)
def test_plugin_loaded_later_runs_in_the_steps_of_the_others(cls, steps):
    model = fake_model()
    model.world.run(7)
    assert seen(make_drive(cls, model, rate='100'), 30) == steps


def test_mean_rate_is_exact_over_a_minute():
    assert len(seen(make(Exact, '30'), 60_000)) == 1800


@pytest.mark.parametrize('cls', [Watcher, Exact])
@pytest.mark.parametrize('rate', ['30', '100', '7', '400', '0'])
def test_late_reader_does_not_shift_the_steps(cls, rate):
    at_once = seen(make(cls, rate), 300)
    for late in (1, 9, 10, 11, 33, 34, 35, 143):
        plugin = make(cls, rate)
        plugin.world.run(late)
        assert seen(plugin, 300 - late) == [step for step in at_once if step > late]
        assert plugin.woken == 1


def test_reporting_plugin_is_not_due_without_readers():
    plugin = make(Watcher, '100')
    assert plugin.due == NEVER
    assert seen(plugin, 25) == [11, 21]
    assert plugin.due == NEVER
    plugin.world.engine.steps.clear()
    plugin.world.run(60)
    assert plugin.world.engine.steps == [60]  # the watchdog's steps are 1 and 101


def test_acting_plugin_is_always_due():
    plugin = make(Actor, '100')
    plugin.world.run(11)
    assert plugin.elapsed == pytest.approx(0.011)
    plugin.world.run(10)
    assert plugin.elapsed == pytest.approx(0.011)  # since the end of the period one step earlier


def test_hook_after_each_step_does_not_run_without_readers():
    plugin = make(Counter, '100')
    plugin.world.run(50)
    assert plugin.count == 0
    assert seen(plugin, 20) == [51, 61]
    assert plugin.count == 20


def test_reset_of_poses_keeps_the_phase_and_reset_of_time_restarts_it():
    plugin, found = make(Exact, '100'), []
    plugin.steps.connect(found.append)
    plugin.world.run(15)
    plugin.world.reset_world()
    plugin.world.run(10)
    plugin.world.reset_simulation()
    plugin.world.run(15)
    assert found == [10, 20, 10]


def test_the_rate_holds_when_steps_get_longer():
    plugin, times = make(Exact, '100'), []
    plugin.steps.connect(lambda _: times.append(plugin.world.clock.now))
    plugin.world.run(15)
    plugin.world.set_physics(replace(plugin.world.physics, step_size=0.004))
    plugin.world.run(10)
    assert times == pytest.approx([0.010, 0.023, 0.031, 0.043, 0.051])


def test_reading_is_computed_once_for_all_readers():
    plugin, one, other = make(Watcher, '0'), [], []
    for found in (one, other):
        plugin.steps.connect(found.append)
    plugin.world.run(3)
    plugin.steps.disconnect(one.append)
    plugin.steps.disconnect(one.append)  # has been disconnected already
    plugin.world.run(1)
    assert (one, other) == ([1, 2, 3], [1, 2, 3, 4])
    assert plugin.steps.wanted
    plugin.steps.disconnect(other.append)
    assert not plugin.steps.wanted


@pytest.mark.parametrize(('tag', 'namespace'), [(None, 'a/robot'), ('', 'robot'), ('/r1', '/r1')])
def test_namespace_rule_is_that_of_the_plugin_class(tag, namespace):
    class Placed(ModelPlugin):
        absent_namespace, empty_namespace, prefix = 'a/{}', '{}', 'P({}): '

    plugin = make_drive(Placed, fake_model(), robotNamespace=tag)
    assert (plugin.namespace, plugin.log_prefix) == (namespace, f'P({namespace}): ')


def test_unknown_tags_are_reported(caplog):
    make_drive(Watcher, fake_model(), rate='1', alwaysOn='1', colour='red', size='2')
    assert 'not read by this plugin: <colour>, <size>' in caplog.messages


def test_plugin_without_hooks_is_never_due():
    plugin = make_drive(ModelPlugin, fake_model())
    plugin.world.run(10)
    assert plugin.due == NEVER
