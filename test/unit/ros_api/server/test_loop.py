"""The loop that owns the world: pacing, commands from other threads, pause and end."""

import contextlib
import itertools
import threading
import time
from types import SimpleNamespace

import pytest

from rosbots_description.ros_api.server.loop import MAX_LAG, Loop, LoopError
from rosbots_description.sim.core.errors import NotFoundError

JOIN = 5.0  # [s] for what takes milliseconds; slow machines are no failure


class CountingWorld:
    """A world that only counts its steps, and can be made slow.

    `interest` is the number of steps after which somebody wants to be called.
    """

    def __init__(self, rate, step_time=0.0, interest=1):
        self.physics = SimpleNamespace(max_update_rate=rate)
        self.paused = False
        self.steps = 0
        self.longest_batch = 0
        self.batches = 0
        self.clock = self
        self.schedule = self
        self._interest = interest
        self._step_time = step_time

    def next_wanted(self):
        return (self.steps // self._interest + 1) * self._interest

    def run(self, steps):
        self.steps += steps
        self.batches += 1
        self.longest_batch = max(self.longest_batch, steps)
        if self._step_time:
            time.sleep(steps * self._step_time)


@pytest.fixture
def start():
    """Run loops on threads of their own, and stop them at the end."""
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


def test_makes_as_many_steps_as_time_has_passed(start):
    world = CountingWorld(rate=1000.0)
    loop = start(world)
    steps, begin = loop.call(lambda: world.steps), time.monotonic()
    time.sleep(0.3)  # the measured quantity itself
    made, passed = loop.call(lambda: world.steps) - steps, time.monotonic() - begin
    assert made == pytest.approx(1000.0 * passed, abs=5)


def test_steps_that_interest_nobody_are_made_in_one_go_but_a_command_finds_them_made(start):
    world = CountingWorld(rate=1000.0, interest=100)
    loop = start(world)
    steps, begin = loop.call(lambda: world.steps), time.monotonic()
    _wait_for(lambda: world.steps >= steps + 300)
    batches, reached = world.batches, world.steps
    assert batches <= reached / 5
    made, passed = loop.call(lambda: world.steps) - steps, time.monotonic() - begin
    assert made == pytest.approx(1000.0 * passed, abs=5)


def test_what_surrounds_a_batch_is_there_while_the_world_runs():
    world, inside = CountingWorld(rate=0.0), []

    @contextlib.contextmanager
    def batch():
        inside.append(world.steps)
        yield
        inside.append(world.steps)

    Loop(world, batch).run(steps=1)
    assert inside == [0, 1]


def test_without_a_rate_runs_as_fast_as_it_can_and_still_serves(start):
    world = CountingWorld(rate=0.0, step_time=1e-5)
    loop = start(world)
    time.sleep(0.1)  # let it find its batch
    begin = time.monotonic()
    assert loop.call(lambda: 'served') == 'served'
    assert time.monotonic() - begin < 0.1
    assert world.longest_batch > 1


def test_a_faster_rate_counts_at_once_also_after_a_very_slow_one(start):
    world = CountingWorld(rate=0.01)
    loop = start(world)
    end = time.monotonic() + JOIN
    while world.steps == 0:  # the next one is due in 100 s
        assert time.monotonic() < end
        time.sleep(0.001)
    loop.call(lambda: setattr(world.physics, 'max_update_rate', 1000.0))
    while world.steps < 50:
        assert time.monotonic() < end
        time.sleep(0.001)


def test_a_slow_world_is_not_asked_for_the_past(start):
    world = CountingWorld(rate=1000.0, step_time=0.002)
    loop = start(world)
    loop.call(lambda: time.sleep(2 * MAX_LAG))
    begin = time.monotonic()
    loop.call(lambda: None)
    assert time.monotonic() - begin < MAX_LAG


def test_makes_no_step_while_paused_but_serves(start):
    world = CountingWorld(rate=1000.0)
    world.paused = True
    loop = start(world)
    assert loop.call(lambda: world.steps) == 0
    loop.call(lambda: setattr(world, 'paused', False))
    _wait_for(lambda: world.steps > 0)


@pytest.mark.parametrize('pause', [0.75 * MAX_LAG, 2.0 * MAX_LAG])
def test_a_pause_is_not_made_up_for(start, pause):
    world = CountingWorld(rate=1000.0)
    loop = start(world)
    loop.call(lambda: setattr(world, 'paused', True))
    time.sleep(pause)
    begin, before = time.monotonic(), world.steps
    loop.call(lambda: setattr(world, 'paused', False))
    _wait_for(lambda: world.steps > before)
    made = loop.call(lambda: world.steps) - before
    assert made <= 1000.0 * (time.monotonic() - begin) + 5


def test_ends_after_the_steps_asked_for():
    world = CountingWorld(rate=0.0)
    Loop(world).run(steps=1234)
    assert world.steps == 1234


def test_a_command_raises_in_the_thread_that_gave_it(start):
    loop = start(CountingWorld(rate=1000.0))

    def fail():
        raise NotFoundError('no such thing')

    with pytest.raises(NotFoundError, match='no such thing'):
        loop.call(fail)
    assert loop.call(lambda: 1) == 1


def test_a_command_from_the_loop_itself_runs_at_once(start):
    loop = start(CountingWorld(rate=1000.0))
    assert loop.call(lambda: loop.call(lambda: 7)) == 7


def test_a_command_that_waited_too_long_is_never_carried_out(start):
    loop = start(CountingWorld(rate=1000.0))
    release, done = threading.Event(), []
    loop.post(lambda: release.wait(JOIN))
    with pytest.raises(LoopError, match=r'busy for 0.05 s and the request was not begun'):
        loop.call(lambda: done.append(1), deadline=0.05)
    release.set()
    loop.call(lambda: None)
    assert done == []


def test_a_fault_in_a_posted_command_is_logged_and_the_loop_lives(start, caplog):
    loop = start(CountingWorld(rate=1000.0))
    loop.post(lambda: 1 / 0)
    assert loop.call(lambda: 'alive') == 'alive'
    assert 'the simulation goes on' in caplog.text


@pytest.mark.parametrize('paused', [False, True])
def test_periodic_tasks_run_also_while_paused(start, paused):
    world = CountingWorld(rate=1000.0)
    world.paused = paused
    loop = Loop(world)
    runs = []
    begin = time.monotonic()
    loop.every(0.01, lambda: runs.append(time.monotonic()))
    thread = threading.Thread(target=loop.run)
    thread.start()
    _wait_for(lambda: len(runs) >= 5)
    loop.stop()
    thread.join(JOIN)
    assert runs[0] - begin >= 0.01
    assert runs[4] - begin >= 0.05


@pytest.fixture
def clock(monkeypatch):
    """Give the loop a wall clock that only moves when the test says so."""
    clock = SimpleNamespace(now=100.0, monotonic=lambda: clock.now)
    monkeypatch.setattr('rosbots_description.ros_api.server.loop.time', clock)
    return clock


def _run_beside(clock, task, period):
    """Let a loop run 1000 steps of 1 ms, and a task each period; return when it began."""
    world, begun = CountingWorld(rate=0.0), []
    world.run = lambda steps: setattr(clock, 'now', clock.now + 0.001 * steps)
    loop = Loop(world)
    loop.every(period, lambda: (begun.append(clock.now), task(len(begun))))
    loop.run(steps=1000)
    return begun


def test_a_periodic_task_that_takes_time_keeps_its_pace(clock):
    begun = _run_beside(clock, lambda _: setattr(clock, 'now', clock.now + 0.005), 0.01)
    begun = begun[50:]  # by then the loop knows what a step costs
    assert len(begun) > 100
    assert begun[-1] - begun[0] == pytest.approx(0.01 * (len(begun) - 1), abs=0.005)


def test_runs_that_a_periodic_task_missed_are_left_out(clock):
    def task(number):
        if number == 3:
            clock.now += 0.5

    begun = _run_beside(clock, task, 0.01)
    gaps = [after - before for before, after in itertools.pairwise(begun)]
    assert max(gaps) >= 0.5
    assert min(gaps) >= 0.005


@pytest.mark.parametrize('paused', [False, True])
def test_stops_at_once_and_then_refuses(paused):
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


def test_work_beside_the_steps_gives_its_result_or_its_fault(start):
    world = CountingWorld(rate=1000.0)
    loop = start(world)
    threads = loop.beside(threading.get_ident), loop.call(threading.get_ident)
    assert len({*threads, threading.get_ident()}) == 3
    with pytest.raises(NotFoundError, match='no such model'):
        loop.beside(_fail)


def _fail():
    raise NotFoundError('no such model')


def test_nobody_waits_for_work_beside_when_the_loop_has_ended():
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
        loop.beside(work)
    assert time.monotonic() - begin < JOIN
    with pytest.raises(LoopError):  # nor does one that comes later
        loop.beside(lambda: end.wait(JOIN))
    end.set()
    thread.join(JOIN)


def _wait_for(condition):
    end = time.monotonic() + JOIN
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.001)
