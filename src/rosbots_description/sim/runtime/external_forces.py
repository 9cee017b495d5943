"""Pushes that last for a while: wrenches on links and efforts on joints."""

from collections.abc import Callable
from dataclasses import dataclass

from ..core import SimClock
from .scheduler import NEVER, Hook


@dataclass(frozen=True)
class Job:
    """Does `push()` in each step from `start_ns` to `end_ns` [ns, simulated]; None: for ever."""

    target: object
    push: Callable[[], None]
    start_ns: int
    end_ns: int | None


class Jobs(Hook):
    """The jobs of a world. They run before all other hooks."""

    def __init__(self, clock: SimClock) -> None:
        self._clock = clock
        self._jobs: list[Job] = []

    def add(
        self,
        target: object,
        push: Callable[[], None],
        start_ns: int,
        duration_ns: int,
    ) -> None:
        """Do `push()` in each step from `start_ns`, or now, for `duration_ns`.

        Args:
            target: the link or joint that is pushed.
            push: done once per step.
            start_ns: when to begin [ns, simulated]; a past time means now.
            duration_ns: how long [ns], both ends included; negative: for ever. A push from now on
                begins with the next step, so that zero means not at all, as in Gazebo.
        """
        start_ns = max(start_ns, self._clock.now_ns)
        end_ns = None if duration_ns < 0 else start_ns + duration_ns
        self._jobs.append(Job(target, push, start_ns, end_ns))
        self._set_due()

    def cancel(self, chosen: Callable[[object], bool]) -> None:
        """Drop the jobs whose target is chosen."""
        self._jobs = [job for job in self._jobs if not chosen(job.target)]
        self._set_due()

    def before_step(self) -> None:
        """Push what is to be pushed in this step and drop what is over."""
        now_ns = self._clock.now_ns
        self._jobs = [job for job in self._jobs if job.end_ns is None or now_ns <= job.end_ns]
        for job in self._jobs:
            if job.start_ns <= now_ns:
                job.push()
        self._set_due()

    def _set_due(self) -> None:
        if not self._jobs:
            self.due = NEVER
            return
        first_ns = min(job.start_ns for job in self._jobs)
        soonest = self._clock.first_step_after(first_ns - 1)
        self.due = max(soonest, self._clock.steps + 1)
