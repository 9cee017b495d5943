"""Loops in processes of their own, measured over windows of time.

Loops that alternate in short windows share whatever else the machine does. The best window of each
counts, since other load can only slow a loop down.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

from child import Child

BATCH = 0.01  # [s, wall] between readings of the clock

Steps = Callable[[int], object]


class WindowedLoop(Child):
    """A loop in a child process that waits between windows: a program that calls `answer`."""

    def begin(self, seconds: float) -> None:
        """Begin a window [s, wall]; `end` waits for it."""
        self.send(str(seconds))

    def end(self) -> float:
        """Return the steps per second over the window."""
        return float(self.answer())

    def speed(self, seconds: float) -> float:
        """Return the steps per second over a window [s, wall]."""
        self.begin(seconds)
        return self.end()


def measure(step: Steps, seconds: float, batch: int) -> float:
    """Return the steps per second over a window [s, wall]; the clock is read once a batch."""
    steps, begin = 0, time.perf_counter()
    while (elapsed := time.perf_counter() - begin) < seconds:
        step(batch)
        steps += batch
    return steps / elapsed


def answer(step: Steps) -> None:
    """Measure windows [s, wall] read from standard input until it ends; print the speeds."""
    batch = max(1, round(BATCH * measure(step, BATCH, 10)))
    for line in sys.stdin:
        print(measure(step, float(line), batch), flush=True)
