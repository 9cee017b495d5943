#!/usr/bin/env python3
"""The real server with a recorder in its steps: how late each step begins.

A step is on time if it begins when the wall clock says it should, the earliest of all steps being
the measure. It is told, too, how late they are without the time in which the loop was ready to go
on and no processor was free. Arguments are gzserver's. At the end what was found goes to a file.
"""

from __future__ import annotations

import json
import os
import sys
import time
from itertools import pairwise

from article import OUTPUT

from rosbots_description.cli import gzserver
from rosbots_description.ros_api import node
from rosbots_description.sim.clock import NANOSECONDS
from rosbots_description.sim.schedule import Hook
from rosbots_description.sim.world import World

RESULT = OUTPUT / 'lateness.json'  # shares of the steps, and how late they were at most [s]
STEP = 0.001  # [s]
FROM = 2000  # the first step that counts: robots and clients are there


class Recorder(Hook):
    """Notes the wall time at which each step begins [s, monotonic]."""

    due = 1

    def __init__(self) -> None:
        """Begin; the thread that calls is the one that will make the steps."""
        self._steps: list[tuple[float, float]] = []  # begun [s, monotonic], waited so far [s]
        self._schedule = os.open('/proc/thread-self/schedstat', os.O_RDONLY)

    def update(self) -> None:
        """Note it, and come again at the next step."""
        waited = int(os.pread(self._schedule, 100, 0).split()[1]) / NANOSECONDS
        self._steps.append((time.monotonic(), waited))
        self.due += 1

    def lateness(self, step: float) -> list[float]:
        """Return how late the steps were, `step` [s] apart, in order [s]."""
        ahead = [begun - step * i for i, (begun, _) in enumerate(self._steps[FROM:])]
        earliest = min(ahead)
        return sorted(begun - earliest for begun in ahead)

    def lateness_of_its_own(self, step: float) -> list[float]:
        """Return the same for a machine on which a processor is always free."""
        late, found = 0.0, []
        for (begun, waited), (begins, waits) in pairwise(self._steps[FROM:]):
            late = max(0.0, late + (begins - begun) - (waits - waited) - step)
            found.append(late)
        return sorted(found)


def main() -> int:
    """Be the server until it is told to stop; return the exit code."""
    recorder = Recorder()

    class RecordedWorld(World):
        def __init__(self) -> None:
            super().__init__()
            self.schedule.add(recorder)

    node.World = RecordedWorld
    code = gzserver.main()
    late, own = recorder.lateness(STEP), recorder.lateness_of_its_own(STEP)
    shares = {'p50': 0.5, 'p99': 0.99, 'p99.9': 0.999}
    found = {name: late[int(share * len(late))] for name, share in shares.items()}
    found |= {'max': late[-1], 'p99 were a processor always free': own[int(0.99 * len(own))]}
    RESULT.write_text(json.dumps(found), encoding='utf-8')
    return code


if __name__ == '__main__':
    sys.exit(main())
