"""The schedule of hooks: each sets the step at which it runs next."""

import logging
import math
from collections.abc import Callable
from fractions import Fraction

from ..core import Fault, FaultPlace, report

NEVER = 1 << 62  # a step count that no simulation reaches
SUSPENSION = 1000  # steps for which a failed hook is suspended, so that it does not flood the log


class Hook:
    """Code that runs at certain steps, before and after physics.

    `due` is the count of the step in which it runs next. Set it in `before_step`, or from outside
    between two runs of the world, on the thread that owns the world. `runs_after_step`, set there
    too, is whether `after_step` is to be called; otherwise this step and those that follow may be
    combined.
    """

    due = NEVER
    runs_after_step = False

    @property
    def place(self) -> FaultPlace:
        """Return where this is, for its faults."""
        return {}

    def before_step(self) -> None:
        """Run before physics, after time has advanced, and set the next `due`."""
        raise NotImplementedError

    def after_step(self) -> None:
        """Run after physics, if `runs_after_step` is set and `before_step` did not fail."""


class PreRunPublisher:
    """Publishes for the steps of a run in advance, as its messages depend on time only.

    `due` is the next step to publish for.
    """

    due = NEVER

    def publish_ahead(self, last: int) -> None:
        """Publish for the coming steps, up to `last`, and set the next `due`."""
        raise NotImplementedError


class Schedule:
    """Hooks in the order they were added; they run in that order within a step."""

    def __init__(self) -> None:
        self._hooks: list[Hook] = []
        self._publishers: list[PreRunPublisher] = []

    def add(self, hook: Hook) -> None:
        """Run `hook` from now on, after the hooks added before it."""
        self._hooks.append(hook)

    def remove(self, hook: Hook) -> None:
        """Stop running `hook`."""
        self._hooks.remove(hook)

    def add_pre_run_publisher(self, publisher: PreRunPublisher) -> None:
        """Run `publisher` from the next run on."""
        self._publishers.append(publisher)

    def publish_ahead(self, last: int) -> None:
        """Let pre-run publishers publish for the coming steps, up to `last`."""
        for publisher in self._publishers:
            if publisher.due <= last:
                try:
                    publisher.publish_ahead(last)
                except Exception:
                    _suspend(publisher, last)

    def next_wanted(self) -> int:
        """Return the earliest step count at which a hook or a pre-run publisher is due."""
        return min(self.next_due(), *(one.due for one in self._publishers), NEVER)

    def next_due(self) -> int:
        """Return the earliest step count at which a hook is due."""
        return min([hook.due for hook in self._hooks], default=NEVER)

    def run(self, step: int, last: int, physics: Callable[[int], None]) -> int:
        """Make one step: every hook that is due at `step` or before, physics, those that watch.

        If none watches, steps of which no hook is due follow in the same call of `physics(steps)`,
        up to `last`. A hook that fails is reported and suspended for a while; the others go on.

        Returns:
            the number of steps made.
        """
        due = [hook for hook in self._hooks if hook.due <= step]
        done = [hook for hook in due if _run_hook(hook, hook.before_step, step)]
        after = [hook for hook in done if hook.runs_after_step]
        steps = 1 if after else max(1, min(self.next_due() - 1, last) - step + 1)
        physics(steps)
        for hook in after:
            _run_hook(hook, hook.after_step, step)
        return steps

    def change_step(self, now: int, ratio: Fraction) -> None:
        """Keep the due times, now that steps last `ratio` times as long.

        A due time between two steps of the new size moves to the later one.
        """
        scheduled: list[Hook | PreRunPublisher] = [*self._hooks, *self._publishers]
        for hook in scheduled:
            if hook.due != NEVER:
                hook.due = now + max(1, math.ceil((hook.due - now) / ratio))


def _run_hook(hook: Hook, work: Callable[[], None], step: int) -> bool:
    """Run a hook; return whether it succeeded."""
    try:
        work()
    except Exception:
        _suspend(hook, step)
        return False
    return True


def _suspend(failed: Hook | PreRunPublisher, step: int) -> None:
    """Report the exception that is being handled, and suspend the hook that raised it."""
    what = f'internal fault of {type(failed).__name__}; the simulation goes on'
    what += f', without it for {SUSPENSION} steps'
    place = failed.place if isinstance(failed, Hook) else FaultPlace()
    report(Fault(what, logging.ERROR, internal=True, **place))
    failed.due = step + SUSPENSION
