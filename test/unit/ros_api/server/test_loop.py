"""The loop that owns the world: pacing, commands from other threads, pause and end."""

import bisect
import contextlib
import itertools
import math
import threading
import time
from dataclasses import replace

import pytest

from rosbots_description.ros_api.server.loop import BATCH, MAX_LAG, Loop, LoopError
from rosbots_description.sim.core.errors import NotFoundError
from rosbots_description.sim.description.physics_settings import PhysicsSettings

JOIN = 30.0  # [s] timeout of what takes milliseconds


class WallClock:
    """A fake wall clock that advances only while the loop waits or works.

    It is the loop's queue as well, so that tests choose the exact time of a command.
    """

    def __init__(self):
        self._now = 100.0
        self._coming = []  # (time, command), sorted

    def monotonic(self):
        return self._now

    def sleep(self, seconds):
        self._now += seconds

    def at(self, when, command):
        """Add a command at `when` [s] from now."""
        bisect.insort(self._coming, (self._now + when, command), key=lambda item: item[0])

    def put(self, command):
        self.at(0.0, command)

    def take_all(self):
        while self._coming and self._coming[0][0] <= self._now:
            yield self._coming.pop(0)[1]

    def wait(self, timeout):
        end = math.inf if timeout is None else self._now + timeout
        self._now = max(self._now, min(end, self._coming[0][0]))


class CountingWorld:
    """A world that counts its steps; they can be made slow.

    `interest` is the number of steps from one hook to the next; `sleep` is how a step
    spends its time.
    """

    def __init__(self, rate, step_time=0.0, interest=1, sleep=time.sleep):
        self.set_rate(rate)
        self.paused = False
        self.steps = 0
        self.longest_batch = 0
        self.batches = 0
        self.clock = self.faults = self
        self.schedule = self
        self._interest = interest
        self._step_time, self._sleep = step_time, sleep

    def set_rate(self, rate):
        self.physics = replace(PhysicsSettings(), max_update_rate=rate)

    def next_wanted(self):
        return (self.steps // self._interest + 1) * self._interest

    def add(self, fault):
        raise AssertionError(fault)

    def run(self, steps):
        self.steps += steps
        self.batches += 1
        self.longest_batch = max(self.longest_batch, steps)
        if self._step_time:
            self._sleep(steps * self._step_time)


def _fail():
    raise NotFoundError('no such model')


@pytest.fixture
def start():
    """Return a function that runs a loop on a new thread; stop all at the end."""
    running = []

    def begin(world, **limits):
        loop = Loop(world)
        thread = threading.Thread(target=loop.run, kwargs=limits)
        thread.start()
        running.append((loop, thread))
        return loop

    yield begin
    for loop, thread in running:
        loop.stop()
        thread.join(JOIN)
        assert not thread.is_alive()


@pytest.fixture
def clock(monkeypatch):
    """Give loops a fake wall clock, independent of the load of the machine."""
    clock = WallClock()
    monkeypatch.setattr('rosbots_description.ros_api.server.loop.time', clock)
    monkeypatch.setattr('rosbots_description.ros_api.server.loop.CommandQueue', lambda: clock)
    return clock


def run_for(clock, loop, seconds):
    """Run a loop for `seconds` of the fake clock."""
    clock.at(seconds, loop.stop)
    loop.run()


def test_step_count_follows_wall_time(clock):
    world = CountingWorld(rate=1000.0)
    run_for(clock, Loop(world), 0.3)
    assert world.steps == pytest.approx(300, abs=1)


def test_steps_without_hooks_are_batched_and_done_before_the_next_command(clock):
    world, found = CountingWorld(1000.0, 1e-6, interest=100, sleep=clock.sleep), []
    loop = Loop(world)
    clock.at(0.25, lambda: found.append(world.steps))
    run_for(clock, loop, 0.3)
    assert found == pytest.approx([250], abs=1)
    assert world.batches <= 300 / 5


def test_batch_context_is_active_while_the_world_runs():
    world, inside = CountingWorld(rate=0.0), []

    @contextlib.contextmanager
    def batch():
        inside.append(world.steps)
        yield
        inside.append(world.steps)

    Loop(world, batch).run(steps=1)
    assert inside == [0, 1]


def test_unthrottled_loop_still_serves_commands(clock):
    world, served = CountingWorld(0.0, 1e-5, sleep=clock.sleep), []
    begin = clock.monotonic()
    clock.at(0.1, lambda: served.append(clock.monotonic() - begin))
    run_for(clock, Loop(world), 0.2)
    assert served == pytest.approx([0.1], abs=2.0 * BATCH)
    assert world.steps == pytest.approx(0.2 / 1e-5, rel=0.05)
    assert world.longest_batch > 1


def test_new_rate_takes_effect_at_once_even_after_a_very_slow_one(clock):
    world = CountingWorld(rate=0.01)  # after the first step the next one is due in 100 s
    clock.at(1.0, lambda: world.set_rate(1000.0))
    run_for(clock, Loop(world), 1.05)
    assert world.steps == pytest.approx(50, abs=2)


@pytest.mark.parametrize(('lag', 'made_up_for'), [(0.5 * MAX_LAG, True), (2.0 * MAX_LAG, False)])
def test_short_delay_is_caught_up_and_a_long_one_is_not(clock, lag, made_up_for):
    world = CountingWorld(rate=1000.0)
    clock.at(0.1, lambda: clock.sleep(lag))
    run_for(clock, Loop(world), 0.2 + lag)
    assert world.steps == pytest.approx(200 + 1000 * lag * made_up_for, abs=2)


def test_paused_loop_makes_no_step_but_serves_commands(clock):
    world, found = CountingWorld(rate=1000.0), []
    world.paused = True
    clock.at(0.1, lambda: found.append(world.steps))
    clock.at(0.2, lambda: setattr(world, 'paused', False))
    run_for(clock, Loop(world), 0.3)
    assert found == [0]
    assert world.steps == pytest.approx(100, abs=1)


@pytest.mark.parametrize('pause', [0.75 * MAX_LAG, 2.0 * MAX_LAG])
def test_pause_is_not_caught_up(clock, pause):
    world = CountingWorld(rate=1000.0)
    clock.at(0.05, lambda: setattr(world, 'paused', True))
    clock.at(0.05 + pause, lambda: setattr(world, 'paused', False))
    run_for(clock, Loop(world), 0.1 + pause)
    assert world.steps == pytest.approx(100, abs=2)


def test_ends_after_the_requested_steps():
    world = CountingWorld(rate=0.0)
    Loop(world).run(steps=1234)
    assert world.steps == 1234


def test_exception_of_a_command_is_raised_in_the_calling_thread(start):
    loop = start(CountingWorld(rate=1000.0))
    with pytest.raises(NotFoundError, match='no such model'):
        loop.call(_fail)
    assert loop.call(lambda: 1) == 1


def test_command_from_the_loops_thread_runs_at_once(start):
    loop = start(CountingWorld(rate=1000.0))
    assert loop.call(lambda: loop.call(lambda: 7)) == 7


def test_command_whose_caller_timed_out_is_not_executed(start):
    loop = start(CountingWorld(rate=1000.0))
    release, done = threading.Event(), []
    loop.post(lambda: release.wait(JOIN))
    with pytest.raises(LoopError, match=r'busy for 0.05 s and the request was not started'):
        loop.call(lambda: done.append(1), deadline=0.05)
    release.set()
    loop.call(lambda: None)
    assert done == []


def test_exception_in_a_posted_command_is_logged_and_the_loop_continues(start, caplog):
    loop = start(CountingWorld(rate=1000.0))
    loop.post(lambda: 1 / 0)
    assert loop.call(lambda: 'alive') == 'alive'
    assert 'the simulation goes on' in caplog.text


@pytest.mark.parametrize('paused', [False, True])
def test_periodic_tasks_also_run_while_paused(clock, paused):
    world, runs = CountingWorld(rate=1000.0), []
    world.paused = paused
    begin, loop = clock.monotonic(), Loop(world)
    loop.every(0.01, lambda: runs.append(clock.monotonic() - begin))
    run_for(clock, loop, 0.055)
    assert runs == pytest.approx([0.01, 0.02, 0.03, 0.04, 0.05], abs=1e-3)


def _run_beside(clock, task, period):
    """Run 1000 steps of 1 ms and a task each period; return the start times of the task [s]."""
    world, begun = CountingWorld(0.0, 0.001, sleep=clock.sleep), []
    loop = Loop(world)
    loop.every(period, lambda: (begun.append(clock.monotonic()), task(len(begun))))
    loop.run(steps=1000)
    return begun


def test_slow_periodic_task_keeps_its_period(clock):
    begun = _run_beside(clock, lambda _: clock.sleep(0.005), 0.01)
    begun = begun[50:]  # the loop has measured the cost of a step
    assert len(begun) > 100
    assert begun[-1] - begun[0] == pytest.approx(0.01 * (len(begun) - 1), abs=0.005)


def test_missed_runs_of_a_periodic_task_are_skipped(clock):
    def task(number):
        if number == 3:
            clock.sleep(0.5)

    begun = _run_beside(clock, task, 0.01)
    gaps = [after - before for before, after in itertools.pairwise(begun)]
    assert max(gaps) >= 0.5
    assert min(gaps) >= 0.005


@pytest.mark.parametrize('paused', [False, True])
def test_stops_at_once_and_rejects_later_commands(paused):
    world = CountingWorld(rate=1.0)
    world.paused = paused
    loop = Loop(world)
    thread = threading.Thread(target=loop.run)
    thread.start()
    loop.stop()
    thread.join(JOIN)
    assert not thread.is_alive()
    with pytest.raises(LoopError, match='shutting down'):
        loop.call(lambda: None)


def test_work_beside_the_loop_returns_its_result_or_raises(start):
    world = CountingWorld(rate=1000.0)
    loop = start(world)
    threads = loop.run_in_thread(threading.get_ident), loop.call(threading.get_ident)
    assert len({*threads, threading.get_ident()}) == 3
    with pytest.raises(NotFoundError, match='no such model'):
        loop.run_in_thread(_fail)


def test_caller_does_not_wait_for_work_beside_an_ended_loop():
    loop, begun, end = Loop(CountingWorld(rate=1000.0)), threading.Event(), threading.Event()
    thread = threading.Thread(target=loop.run)
    thread.start()

    def work():
        begun.set()
        end.wait(JOIN)

    def stop():
        begun.wait(JOIN)
        loop.stop()

    threading.Thread(target=stop).start()
    begin = time.monotonic()
    with pytest.raises(LoopError, match='the simulator is shutting down'):
        loop.run_in_thread(work)
    assert time.monotonic() - begin < JOIN
    with pytest.raises(LoopError):  # later calls neither
        loop.run_in_thread(lambda: end.wait(JOIN))
    end.set()
    thread.join(JOIN)
