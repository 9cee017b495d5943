#!/usr/bin/env python3
"""The real server with a recorder of the start times of steps and of wheel targets.

Arguments are gzserver's. The record is written to a file at the end; `read` returns it.
"""

from __future__ import annotations

import json
import os
import sys
import time
from typing import NamedTuple

from article import OUTPUT

from rosbots_description.cli import gzserver
from rosbots_description.ros_api.node import node
from rosbots_description.sim.core.clock import NANOSECONDS
from rosbots_description.sim.runtime.model import Joint
from rosbots_description.sim.runtime.scheduler import Hook
from rosbots_description.sim.runtime.world import World

_FILE = OUTPUT / 'recorded.json'


class Record(NamedTuple):
    """Recorded times; wall times are of the monotonic clock, which all processes share.

    `steps`: start time of each step, and total time until then that the loop waited for a
    processor [s]. `targets`: time and value of each new target of a left wheel [s, rad/s].
    """

    steps: list[tuple[float, float]]
    targets: list[tuple[float, float]]


class Recorder(Hook):
    """Records each step and each new target of a left wheel."""

    due = 1

    def __init__(self) -> None:
        """Begin; call this on the thread that will run the steps."""
        self._record = Record([], [])
        self._schedule = os.open('/proc/thread-self/schedstat', os.O_RDONLY)

    def before_step(self) -> None:
        """Record the start time of the step; be due at the next one."""
        waited = int(os.pread(self._schedule, 100, 0).split()[1]) / NANOSECONDS
        self._record.steps.append((time.monotonic(), waited))
        self.due += 1

    def record_target(self, left: float) -> None:
        """Record a target [rad/s] if it is new."""
        targets = self._record.targets
        if not targets or targets[-1][1] != left:
            targets.append((time.monotonic(), left))

    def save(self) -> None:
        """Write the record to the file."""
        _FILE.write_text(json.dumps(self._record), encoding='utf-8')


def read() -> Record:
    """Return the record of the server that ended last."""
    return Record(*json.loads(_FILE.read_text(encoding='utf-8')))


def main() -> int:
    """Run the server until it is shut down; return the exit code."""
    recorder = Recorder()
    set_motor = Joint.set_motor

    class RecordedWorld(World):
        def __init__(self) -> None:
            super().__init__()
            self.schedule.add(recorder)

    def recorded_set_motor(joint: Joint, velocity: float, effort: float) -> None:
        set_motor(joint, velocity, effort)
        if 'left' in joint.name:
            recorder.record_target(velocity)

    vars(node)['World'] = RecordedWorld
    Joint.set_motor = recorded_set_motor  # type: ignore[method-assign, assignment]  # on purpose
    code = gzserver.main()
    recorder.save()
    return code


if __name__ == '__main__':
    sys.exit(main())
