#!/usr/bin/env python3
"""The real server with a recorder in its steps: how late each step begins.

A step is on time if it begins when the wall clock says it should, the earliest of all steps being
the measure. Arguments are gzserver's. At the end what was found goes to a file.
"""

from __future__ import annotations

import json
import sys
import time

from article import OUTPUT

from rosbots_description.cli import gzserver
from rosbots_description.ros_api import node
from rosbots_description.sim.schedule import Hook
from rosbots_description.sim.world import World

RESULT = OUTPUT / 'lateness.json'  # shares of the steps, and how late they were at most [s]
FROM = 2000  # the first step that counts: robots and clients are there


class Recorder(Hook):
    """Notes the wall time at which each step begins [s, monotonic]."""

    due = 1

    def __init__(self) -> None:
        self.begun: list[float] = []

    def update(self) -> None:
        """Note it, and come again at the next step."""
        self.begun.append(time.monotonic())
        self.due += 1

    def lateness(self, step: float) -> list[float]:
        """Return how late the steps were, `step` [s] apart, in order [s]."""
        ahead = [begun - step * i for i, begun in enumerate(self.begun[FROM:])]
        earliest = min(ahead)
        return sorted(begun - earliest for begun in ahead)


def main() -> int:
    """Be the server until it is told to stop; return the exit code."""
    recorder = Recorder()

    class RecordedWorld(World):
        def __init__(self) -> None:
            super().__init__()
            self.schedule.add(recorder)

    node.World = RecordedWorld
    code = gzserver.main()
    late = recorder.lateness(0.001)
    shares = {'p50': 0.5, 'p99': 0.99, 'p99.9': 0.999}
    found = {name: late[int(share * len(late))] for name, share in shares.items()}
    RESULT.write_text(json.dumps({**found, 'max': late[-1]}), encoding='utf-8')
    return code


if __name__ == '__main__':
    sys.exit(main())
