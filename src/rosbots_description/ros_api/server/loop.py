"""The one thread that owns the World: it paces the steps and serves commands between them."""

import contextlib
import logging
import threading
import time
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, wait
from contextlib import AbstractContextManager
from contextvars import copy_context
from typing import TYPE_CHECKING, Any, TypeVar

from ...sim.core import SimError, reporting_to
from ...sim.runtime import NEVER
from .command_queue import CommandQueue

if TYPE_CHECKING:
    from ...sim.runtime import World

logger = logging.getLogger(__name__)

DEADLINE = 60.0  # how long a caller waits for its command [s, wall]
BATCH = 0.005  # the queue is checked at least this often [s, wall]
BACKLOG = 0.0005  # steps without due hooks are deferred up to this amount of work [s, wall]
_CLOSING = 'the simulator is shutting down'
MAX_LAG = 0.2  # if the loop is later than this, it does not catch up [s, wall]


Result = TypeVar('Result')


class LoopError(SimError):
    """A command that the loop did not carry out."""


class Loop:
    """Runs a World on the thread that calls `run`; other threads hand it commands.

    While the world is paused no steps are made, but commands are served. Steps without due hooks
    are deferred and made in one call, at the latest before the next command or task, so that no
    caller sees a world that lags behind.
    """

    def __init__(
        self,
        world: 'World',
        batch: Callable[[], AbstractContextManager[None]] = contextlib.nullcontext,
    ) -> None:
        """Create the loop; `run` starts it.

        Args:
            batch: makes a context manager that is entered around each batch of steps.
        """
        self._world = world
        self._batch = batch
        self._commands = CommandQueue()
        self._tasks: list[_Task] = []
        self._stopping = False
        self._ended: Future[None] = Future()  # done when `run` has returned
        self._owner: int | None = None
        self._next_step = 0.0  # when the next step is due [s, monotonic]
        self._step_cost = 0.0  # smoothed wall time of one step [s]
        self._left: int | None = None  # steps still to make; None: no limit

    def call(self, command: Callable[[], Result], deadline: float = DEADLINE) -> Result:
        """Carry out `command()` between two steps and return its result, or raise its exception.

        Callable from any thread; on the loop's own it runs at once. A command whose `deadline`
        [s, wall] passed before its turn is never carried out.

        Raises:
            LoopError: the deadline passed or the simulator is shutting down.

        """
        if threading.get_ident() == self._owner:
            return command()
        future: Future[Result] = Future()
        self._commands.put(lambda: _execute(future, command))
        if self._stopping:
            future.cancel()
        try:
            return future.result(deadline)
        except CancelledError:
            raise LoopError(_CLOSING) from None
        except TimeoutError:
            state = 'was not started' if future.cancel() else 'is not finished'
            raise LoopError(
                f'the simulator was busy for {deadline:g} s and the request {state}; '
                'try again, or check whether a model is too expensive to simulate'
            ) from None

    def run_in_thread(self, work: Callable[[], Result]) -> Result:
        """Return `work()`, or raise its exception; it runs on a new thread, parallel to the steps.

        The work runs in the caller's context (contextvars).

        Raises:
            LoopError: the simulator is shutting down; the result of the work is discarded.

        """
        future: Future[Result] = Future()

        def reporting() -> Result:
            with reporting_to(self._world.faults.add):
                return work()

        threading.Thread(
            target=copy_context().run,
            args=(_execute, future, reporting),
            name='beside',
            daemon=True,
        ).start()
        either: list[Future[Any]] = [future, self._ended]
        wait(either, return_when=FIRST_COMPLETED)
        if not future.done():
            raise LoopError(_CLOSING)
        return future.result()

    def post(self, command: Callable[[], None]) -> None:
        """Carry out `command()` between two steps, without waiting; any thread may post."""
        self._commands.put(command)

    def every(self, period: float, task: Callable[[], None]) -> None:
        """Run `task()` every `period` [s, wall] from now on, also while paused."""
        self._tasks.append(_Task(period, task))

    @property
    def stopping(self) -> bool:
        """Whether `stop` was called, or `run` has returned."""
        return self._stopping

    def stop(self) -> None:
        """Make `run` return after the current step; safe in signal handlers."""
        self._stopping = True
        self._commands.put(_nothing)

    def run(self, steps: int | None = None) -> None:
        """Own the world until `stop`, or until `steps` steps were made."""
        self._owner = threading.get_ident()
        self._next_step = time.monotonic()
        self._left = steps
        with reporting_to(self._world.faults.add):
            self._serve()
            while not self._stopping and self._left != 0:
                self._advance()
                self._serve()
                self._run_tasks()
                self._wait()
            self._stopping = True
            self._serve()
        self._ended.set_result(None)

    def _serve(self) -> None:
        """Carry out everything in the queue."""
        for command in self._commands.take_all():
            if self._world.paused:
                self._next_step = time.monotonic()  # do not catch up for a pause, however short
            _run_safely(command)

    def _run_tasks(self) -> None:
        for task in self._tasks:
            now = time.monotonic()
            if now >= task.next_run:
                _run_safely(task.run)
                task.next_run += task.period
                if task.next_run <= now:  # more than a period late: skip the missed runs
                    task.next_run = now + task.period

    def _advance(self) -> None:
        """Make the steps that are due, at most for `BATCH`."""
        if self._world.paused or self._stopping:
            return
        rate = self._world.physics.max_update_rate
        now = time.monotonic()
        batch = max(1, int(BATCH / self._step_cost)) if self._step_cost else 1
        if rate > 0.0:
            if now - self._next_step > MAX_LAG:
                self._next_step = now
            if now < self._due(now, rate):
                return
            batch = min(batch, int((now - self._next_step) * rate + 1.0))
            self._next_step += batch / rate
        if self._left is not None:
            batch = min(batch, self._left)
            self._left -= batch
        self._world.is_paced = rate > 0.0
        with self._batch():
            self._world.run(batch)
        self._world.is_paced = False
        cost = (time.monotonic() - now) / batch
        self._step_cost += 0.1 * (cost - self._step_cost)

    def _wait(self) -> None:
        """Sleep until a step or task is due or a command arrives."""
        now = time.monotonic()
        wakes = [task.next_run for task in self._tasks]
        if not self._world.paused:
            wakes.append(self._next_needed(now))
        timeout = min(wakes) - now if wakes else None
        if not self._stopping and (timeout is None or timeout > 0.0):
            self._commands.wait(timeout)

    def _due(self, now: float, rate: float) -> float:
        """Return when the next step is due, at most a step from now [s, monotonic].

        After a change of rate it may have been planned for much later.
        """
        self._next_step = min(self._next_step, now + 1.0 / rate)
        return self._next_step

    def _next_needed(self, now: float) -> float:
        """Return when the loop has to make steps again [s, monotonic]."""
        rate, world = self._world.physics.max_update_rate, self._world
        if rate <= 0.0:
            return 0.0
        unnoticed = min(
            world.schedule.next_wanted() - world.clock.steps - 1,
            int(BACKLOG / self._step_cost) if self._step_cost else 0,
            NEVER if self._left is None else self._left - 1,
        )
        return self._due(now, rate) + max(0, unnoticed) / rate


class _Task:
    """A function that runs every `period` [s, wall]."""

    def __init__(self, period: float, run: Callable[[], None]) -> None:
        self.period = period
        self.run = run
        self.next_run = time.monotonic() + period


def _execute(future: Future[Result], command: Callable[[], Result]) -> None:
    """Run `command` unless its caller has given up, and set the result of the future."""
    if not future.set_running_or_notify_cancel():
        return
    try:
        result = command()
    except Exception as error:  # every exception of a command goes to its caller
        future.set_exception(error)
    else:
        future.set_result(result)


def _run_safely(run: Callable[[], None]) -> None:
    """Run a function without a waiting caller; log its errors, so that the simulation continues."""
    try:
        run()
    except SimError as error:
        logger.error('%s', error)
    except Exception:
        logger.exception('internal error; the simulation goes on')


def _nothing() -> None:
    """Wake the loop."""
