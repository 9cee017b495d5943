"""Clock as a count of steps, and hooks at their due steps."""

from fractions import Fraction

import pytest

from rosbots_description.sim.core.clock import SimClock
from rosbots_description.sim.runtime.scheduler import (
    NEVER,
    SUSPENSION,
    Hook,
    PreRunPublisher,
    Schedule,
)


def test_time_is_exact_after_a_million_steps():
    clock = SimClock(0.001)
    clock.steps += 1_000_000
    assert clock.now_ns == 1000 * 10**9


def test_new_step_size_applies_to_later_steps():
    clock = SimClock(0.001)
    clock.steps += 500
    clock.set_step_size(0.002)
    clock.steps += 10
    assert clock.now == pytest.approx(0.52, abs=1e-12)


def test_the_first_step_after_a_time_is_strictly_later():
    clock = SimClock(0.001)
    assert clock.first_step_after(10_000_000) == 11
    assert clock.first_step_after(10_000_001) == 11
    assert clock.first_step_after(9_999_999) == 10


def test_first_step_after_still_holds_when_the_step_size_has_changed():
    clock = SimClock(0.001)
    clock.steps += 10
    clock.set_step_size(0.005)
    step = clock.first_step_after(20_000_000)
    clock.steps = step
    assert clock.now_ns == 25_000_000


def test_reset_restarts_at_zero():
    clock = SimClock(0.001)
    clock.steps += 7
    clock.set_step_size(0.01)
    clock.reset()
    assert (clock.now_ns, clock.steps) == (0, 0)


class Every(Hook):
    def __init__(self, period, log, name):
        self.period, self.log, self.name = period, log, name
        self.due = period

    def before_step(self):
        self.log.append((self.due, self.name))
        self.due += self.period


def test_hooks_run_in_the_order_they_were_added():
    schedule, log = Schedule(), []
    schedule.add(Every(2, log, 'a'))
    schedule.add(Every(1, log, 'b'))
    for step in range(1, 5):
        schedule.run(step, step, lambda _: None)
    assert log == [(1, 'b'), (2, 'a'), (2, 'b'), (3, 'b'), (4, 'a'), (4, 'b')]


def test_an_empty_schedule_is_never_due():
    schedule = Schedule()
    assert schedule.next_due() == NEVER
    hook = Every(3, [], 'a')
    schedule.add(hook)
    assert schedule.next_due() == 3
    schedule.remove(hook)
    assert schedule.next_due() == NEVER


@pytest.mark.parametrize(
    ('ratio', 'due'),
    [(Fraction(2), 15), (Fraction(4), 13), (Fraction(1, 5), 60), (Fraction(100), 11)],
)
def test_hooks_keep_their_due_time_when_the_step_size_changes(ratio, due):
    schedule, idle, busy = Schedule(), Every(NEVER, [], 'idle'), Every(20, [], 'busy')
    schedule.add(idle)
    schedule.add(busy)
    schedule.change_step(10, ratio)
    assert (busy.due, idle.due) == (due, NEVER)


class Broken(Hook):
    """Fails whenever it is run."""

    due = 1
    runs = 0

    def before_step(self):
        self.runs += 1
        raise RuntimeError('hook failed')


def test_a_hook_runs_before_and_after_the_physics_of_the_step_in_which_it_is_due():
    log, schedule = [], Schedule()

    class Reporter(Every):
        runs_after_step = True

        def after_step(self):
            log.append('after')

    schedule.add(Reporter(2, log, 'update'))
    for step in (1, 2, 3):
        schedule.run(step, step, lambda _: log.append('physics'))
    assert [entry if isinstance(entry, str) else 'before' for entry in log] == [
        'physics',
        'before',
        'physics',
        'after',
        'physics',
    ]


def test_failing_hook_is_skipped_for_a_while_and_the_others_run(caplog):
    schedule, log, broken = Schedule(), [], Broken()
    schedule.add(broken)
    schedule.add(Every(1, log, 'a'))
    for step in range(1, 2 + SUSPENSION):
        schedule.run(step, step, lambda _: None)
    assert len(log) == 1 + SUSPENSION
    assert broken.runs == 2
    assert [r.getMessage() for r in caplog.records] == [
        f'internal fault of Broken; the simulation goes on, without it for {SUSPENSION} steps'
    ] * 2


class EveryThird(PreRunPublisher):
    """Publishes every third step."""

    due = 3

    def __init__(self):
        self.published = []

    def publish_ahead(self, last):
        while self.due <= last:
            self.published.append(self.due)
            self.due += 3


def test_pre_run_publisher_publishes_each_of_several_steps_once():
    schedule, publisher = Schedule(), EveryThird()
    schedule.add_pre_run_publisher(publisher)
    for last in (1, 2, 7, 7, 12):
        schedule.publish_ahead(last)
    assert publisher.published == [3, 6, 9, 12]


def test_next_due_step_is_the_least_of_hooks_and_pre_run_publishers():
    schedule, publisher = Schedule(), EveryThird()
    assert schedule.next_wanted() == NEVER
    schedule.add_pre_run_publisher(publisher)
    assert (schedule.next_wanted(), schedule.next_due()) == (3, NEVER)
    schedule.add(Every(2, [], 'a'))
    assert schedule.next_wanted() == 2


def test_failing_pre_run_publisher_is_skipped_for_a_while(caplog):
    schedule, publisher = Schedule(), EveryThird()
    publisher.published = None
    schedule.add_pre_run_publisher(publisher)
    schedule.publish_ahead(5)
    assert publisher.due == 5 + SUSPENSION
    assert 'internal fault of EveryThird' in caplog.text
