#!/usr/bin/env python3
"""The real server with a recorder in its steps: how late each step begins.

A step is on time if it begins when the wall clock says it should, the earliest of all steps being
the measure. The quietest of several windows counts: whatever else the machine does can only make
steps late. `report` tells, too, how late all of them were, and how late without the time in which
the loop was ready to go on and no processor was free.

Arguments are gzserver's. At the end what was noted goes to a file.
"""

from __future__ import annotations

import json
import os
import sys
import time
from itertools import chain, pairwise

from article import OUTPUT

from rosbots_description.cli import gzserver
from rosbots_description.ros_api import node
from rosbots_description.sim.clock import NANOSECONDS
from rosbots_description.sim.schedule import Hook
from rosbots_description.sim.world import World

RECORD = OUTPUT / 'lateness.json'
STEP = 0.001  # [s]
WINDOW = 2000  # steps

Begins = list[tuple[float, float]]  # of steps: begun [s, monotonic], waited in all till then [s]


class Recorder(Hook):
    """Notes the wall time at which each step begins [s, monotonic]."""

    due = 1

    def __init__(self) -> None:
        """Begin; the thread that calls is the one that will make the steps."""
        self._steps: Begins = []
        self._schedule = os.open('/proc/thread-self/schedstat', os.O_RDONLY)

    def update(self) -> None:
        """Note it, and come again at the next step."""
        waited = int(os.pread(self._schedule, 100, 0).split()[1]) / NANOSECONDS
        self._steps.append((time.monotonic(), waited))
        self.due += 1

    def save(self) -> None:
        """Write what was noted to the file."""
        RECORD.write_text(json.dumps(self._steps), encoding='utf-8')


def report(begin: float, end: float) -> dict[str, float]:
    """Return how late steps were [s] between two simulated times [s], by what it is of them."""
    steps: Begins = json.loads(RECORD.read_text(encoding='utf-8'))
    steps = steps[round(begin / STEP) : round(end / STEP)]
    windows = [steps[i : i + WINDOW] for i in range(0, len(steps) - WINDOW + 1, WINDOW)]
    late = [lateness(window) for window in windows]
    shares = {'p50': 0.5, 'p99': 0.99, 'p99.9': 0.999}
    found = {name: min(at(share, one) for one in late) for name, share in shares.items()}
    found['p99 of all windows'] = at(0.99, sorted(chain(*late)))
    found['max of all windows'] = max(one[-1] for one in late)
    own = sorted(chain(*map(lateness_of_its_own, windows)))
    found['p99 of all were a processor always free'] = at(0.99, own)
    return found


def lateness(steps: Begins) -> list[float]:
    """Return how late the steps were, in order [s]."""
    ahead = [begun - STEP * i for i, (begun, _) in enumerate(steps)]
    earliest = min(ahead)
    return sorted(begun - earliest for begun in ahead)


def lateness_of_its_own(steps: Begins) -> list[float]:
    """Return the same for a machine on which a processor is always free."""
    late, found = 0.0, []
    for (begun, waited), (begins, waits) in pairwise(steps):
        late = max(0.0, late + (begins - begun) - (waits - waited) - STEP)
        found.append(late)
    return sorted(found)


def at(share: float, late: list[float]) -> float:
    """Return how late that share of the steps was at most [s]."""
    return late[int(share * len(late))]


def main() -> int:
    """Be the server until it is told to stop; return the exit code."""
    recorder = Recorder()

    class RecordedWorld(World):
        def __init__(self) -> None:
            super().__init__()
            self.schedule.add(recorder)

    node.World = RecordedWorld
    code = gzserver.main()
    recorder.save()
    return code


if __name__ == '__main__':
    sys.exit(main())
