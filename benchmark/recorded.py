#!/usr/bin/env python3
"""The real server with a recorder in it: when each step begins, and when wheels are told what.

Arguments are gzserver's. At the end what was noted goes to a file, which `read` reads.
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
    """What was noted. Wall times are of the monotonic clock, which all processes share.

    `steps` tells when each began, and how long the loop had been waiting for a processor in all
    till then [s]; `targets` when a left wheel got which new target [s, rad/s].
    """

    steps: list[tuple[float, float]]
    targets: list[tuple[float, float]]


class Recorder(Hook):
    """Notes each step and each new target of a left wheel."""

    due = 1

    def __init__(self) -> None:
        """Begin; the thread that calls is the one that will make the steps."""
        self._record = Record([], [])
        self._schedule = os.open('/proc/thread-self/schedstat', os.O_RDONLY)

    def before_step(self) -> None:
        """Note when the step begins, and come again at the next one."""
        waited = int(os.pread(self._schedule, 100, 0).split()[1]) / NANOSECONDS
        self._record.steps.append((time.monotonic(), waited))
        self.due += 1

    def note_target(self, left: float) -> None:
        """Note a target if it is new [rad/s]."""
        targets = self._record.targets
        if not targets or targets[-1][1] != left:
            targets.append((time.monotonic(), left))

    def save(self) -> None:
        """Write what was noted to the file."""
        _FILE.write_text(json.dumps(self._record), encoding='utf-8')


def read() -> Record:
    """Return what the last server noted that has ended."""
    return Record(*json.loads(_FILE.read_text(encoding='utf-8')))


def main() -> int:
    """Be the server until it is told to stop; return the exit code."""
    recorder = Recorder()
    set_motor = Joint.set_motor

    class RecordedWorld(World):
        def __init__(self) -> None:
            super().__init__()
            self.schedule.add(recorder)

    def recorded_set_motor(joint: Joint, velocity: float, effort: float) -> None:
        set_motor(joint, velocity, effort)
        if 'left' in joint.name:
            recorder.note_target(velocity)

    vars(node)['World'] = RecordedWorld
    Joint.set_motor = recorded_set_motor  # type: ignore[method-assign, assignment]  # on purpose
    code = gzserver.main()
    recorder.save()
    return code


if __name__ == '__main__':
    sys.exit(main())
