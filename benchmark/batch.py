#!/usr/bin/env python3
"""Batches on Ray while workers are killed: a thousand runs, none lost; and what Ray costs.

Each run is ten seconds of the article's robot in a room. Every 20 s a worker at random is killed.
Prints the time that Ray needs to start, what it adds to a run, and runs per second. The exit code
is 1 if a run is lost, or if its row depends on the workers.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import random
import signal
import sys
import threading
import time
from pathlib import Path
from typing import Any

from rosbots_description.batch import run
from rosbots_description.cli.launched import descendants

KILL_PERIOD = 20.0  # [s, wall]
COMPARED = 50  # rows that are made again without Ray
SHORT = 1000  # runs of one step, to see what a run costs beside the simulation
SCENARIO: dict[str, Any] = {
    'duration': 10.0,
    'world': 'room',
    'models': [
        {
            'name': 'rosbots',
            'file': 'package://rosbots_description/urdf/rosbots.xacro',
            'pose': {'z': 0.5, 'yaw': '$yaw'},
        }
    ],
    'commands': [
        {
            'at': 1.0,
            'topic': '/part2_cmr/cmd_vel',
            'message': {'linear': {'x': '$speed'}, 'angular': {'z': 0.2}},
        }
    ],
    'record': {
        'x': {'model': 'rosbots', 'value': 'pose.position.x'},
        'odom_x': {'topic': '/rosbots/odom', 'value': 'pose.position.x'},
    },
    'conditions': ['abs(x_end - odom_x_end) < 0.1'],
    'parameters': {'yaw': {'uniform': [-3.14, 3.14]}, 'speed': {'uniform': [0.1, 0.5]}},
    'seed': 1,
}
EMPTY: dict[str, Any] = {'duration': 0.001, 'world': 'empty', 'repeat': SHORT}


class Killer:
    """Kills a worker at random now and then, on a thread of its own."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)
        self._over = threading.Event()
        self.killed = 0

    def __enter__(self) -> Killer:
        threading.Thread(target=self._kill, daemon=True).start()
        return self

    def __exit__(self, *_exception: object) -> None:
        self._over.set()

    def _kill(self) -> None:
        while not self._over.wait(KILL_PERIOD):
            workers = [process for process in descendants(os.getpid()) if _is_at_work(process)]
            if workers:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(self._random.choice(workers), signal.SIGKILL)
                    self.killed += 1


def _is_at_work(process: int) -> bool:
    with contextlib.suppress(OSError):
        return Path(f'/proc/{process}/cmdline').read_bytes().startswith(b'ray::_simulate')
    return False


def soak(runs: int, workers: int) -> int:
    """Make the runs while workers are killed; return the exit code."""
    begin = time.monotonic()
    with Killer(1) as killer:
        made = run(SCENARIO | {'repeat': runs}, workers=workers)
    seconds = time.monotonic() - begin
    outcomes = made.outcomes
    print(f'{runs} runs of 10 s on {workers} workers: {seconds:.0f} s, {runs / seconds:.2f} runs/s')
    print(f'{killer.killed} workers killed, {made.repeated} runs repeated, {outcomes}')
    first = min(runs, COMPARED)
    again = run(SCENARIO | {'repeat': runs}, workers=0, only=range(first))
    same = again.table.equals(made.table.slice(0, first))
    print(f'the first {first} rows are {"the same" if same else "NOT the same"} without Ray')
    return 0 if same and made.table.num_rows == runs and not outcomes['error'] else 1


def costs(workers: int) -> None:
    """Print what Ray costs: to start, and for each run."""
    first: list[float] = []

    def note(_rows: int, _total: int, _repeated: int) -> None:
        first.append(time.monotonic())

    begin = time.monotonic()
    run(EMPTY, workers=workers, progress=note)
    print(f'Ray: {first[0] - begin:.1f} s from the call to the first row')
    on_ray = (first[-1] - first[0]) / (SHORT - 1) * workers
    first.clear()
    run(EMPTY, workers=0, progress=note)
    alone = (first[-1] - first[0]) / (SHORT - 1)
    print(
        f'a run of one step: {1000 * alone:.1f} ms in one process, {1000 * on_ray:.1f} ms of a '
        f'worker on Ray'
    )


def main() -> int:
    """Measure; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.partition('\n\n')[0])
    parser.add_argument('--runs', type=int, default=1000)
    parser.add_argument('--workers', type=int, default=2)
    arguments = parser.parse_args()
    costs(arguments.workers)
    return soak(arguments.runs, arguments.workers)


if __name__ == '__main__':
    sys.exit(main())
