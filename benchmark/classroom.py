#!/usr/bin/env python3
"""Measure a class: many viewers of one world, and many worlds with a viewer each, also over ROS.

Clients that decode the page's connection take the browsers' places, on the same processors: what
browsers draw is their own affair. A robot drives in each world, so that there is motion to show.
"""

from __future__ import annotations

import os
import re
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from server import (
    PATIENCE,
    SYSTEM_TIME,
    USER_TIME,
    Server,
    free_port,
    launched,
    run_in_new_process,
    wait_until,
)
from support.browser import Browser
from web import Window

WINDOW = 8.0  # [s, wall]
VIEWERS, WORLDS = 20, 10
LEAST_FACTOR, LEAST_RATE = 0.95, 20.0  # of real time; [Hz] of a viewer's frames
ROBOT = Path(__file__).resolve().parents[1] / 'urdf' / 'rosbots.xacro'
ADDRESS = re.compile(r'(?:rosbots-view|gzweb): the world is at (\S+)')
CLOCK = re.compile(r'real time (\d+):(\d+):([\d.]+), .*<b>(\d+):(\d+):([\d.]+)<')
POLL = 0.25  # [s, wall] between two looks at a viewer's clock
HOLD = 0.3  # [s, wall] between two commands to drive, which last for 0.6 s


class Ready:
    """Counts those who are ready."""

    def __init__(self, wanted: int) -> None:
        self._lock = threading.Lock()
        self._missing = wanted

    def count(self) -> None:
        """Count one more."""
        with self._lock:
            self._missing -= 1

    def are_all(self) -> bool:
        """Return whether all are ready."""
        return self._missing <= 0


class Viewer:
    """A browser that counts the frames in which a robot moves, and reads the page's clock."""

    def __init__(self, address: str) -> None:
        self.browser = Browser(address)
        self.frames = 0
        self.clocks: list[tuple[float, float]] = []  # simulated and real time [s]

    def wait_for(self, model: str, drives: bool) -> None:
        """Wait until the page shows a model, and has a button to drive if it is to."""
        self.browser.wait_until(
            lambda: (
                self._node(model)
                and self._clock()
                and (not drives or self.browser.control('Forward'))
            ),
            PATIENCE,
        )

    def watch(self, model: str, ready: Ready, drives: bool) -> None:
        """Look for a window of time, and drive if that is wanted, once all viewers see a model."""
        self.wait_for(model, drives)
        ready.count()
        self.browser.wait_until(ready.are_all, PATIENCE)
        node, commanded, looked = self._node(model), 0.0, 0.0
        end = time.monotonic() + WINDOW
        self.browser.messages.clear()
        while (now := time.monotonic()) < end:
            if drives and now - commanded > HOLD:
                self.browser.hold('Forward')
                commanded = now
            self.browser.read(0.05)
            self.frames += sum(
                message['type'] == 'SetPositionMessage' and message['name'] == node
                for message in self.browser.messages
            )
            self.browser.messages.clear()
            if now - looked > POLL:
                self.clocks.append(self._clock() or (0.0, 0.0))
                looked = now
        self.browser.close()  # who does not read any more closes slowly

    @property
    def factor(self) -> float:
        """Return the real-time factor that the page's clock has shown."""
        (first, begun), (last, ended) = self.clocks[0], self.clocks[-1]
        return (last - first) / max(ended - begun, 1e-9)

    def _node(self, model: str) -> str:
        return next(
            (node for node in self.browser.nodes if re.fullmatch(f'/models/{model}/[^/]+', node)),
            '',
        )

    def _clock(self) -> tuple[float, float] | None:
        match = CLOCK.search('\n'.join(self.browser.contents()))
        if match is None:
            return None
        numbers = [float(number) for number in match.groups()]
        real, simulated = (
            3600.0 * hours + 60.0 * minutes + seconds
            for hours, minutes, seconds in (numbers[:3], numbers[3:])
        )
        return simulated, real


def watch_all(viewers: Sequence[Viewer], model: str, drives: bool) -> None:
    """Let all viewers look at once, each on a thread; all read meanwhile, or they would be slow."""
    ready = Ready(len(viewers))
    threads = [
        threading.Thread(target=viewer.watch, args=(model, ready, drives)) for viewer in viewers
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def tell(what: str, viewers: Sequence[Viewer]) -> None:
    """Print the median and the least of what the viewers saw."""
    factors = [viewer.factor for viewer in viewers]
    rates = [viewer.frames / WINDOW for viewer in viewers]
    print(
        f'{what}: real-time factor {statistics.median(factors):.2f}, the least '
        f'{min(factors):.2f} (target {LEAST_FACTOR:g}); a viewer gets '
        f'{statistics.median(rates):.0f} frames per second, the least {min(rates):.0f} '
        f'(target {LEAST_RATE:g})'
    )


def measure_viewers() -> None:
    """Print what viewers of one world see, by the address for looking."""
    with ExitStack() as stack:
        server = stack.enter_context(Server())
        server.spawn()
        server.drive()
        window = stack.enter_context(Window('--max-viewers', str(VIEWERS)))
        viewers = [Viewer(window.viewing_address) for _ in range(VIEWERS)]
        for viewer in viewers:
            stack.enter_context(viewer.browser)
        watch_all(viewers, 'robot0', drives=False)
        tell(f'{VIEWERS} viewers of one world', viewers)


def cpu_seconds(process: int) -> float:
    """Return the processor time of a process so far [s]."""
    stat = Path(f'/proc/{process}/stat').read_text(encoding='ascii').rsplit(')', 1)[1].split()
    return (int(stat[USER_TIME]) + int(stat[SYSTEM_TIME])) / os.sysconf('SC_CLK_TCK')


def megabytes(process: int) -> float:
    """Return the memory that a process has to itself [MB]."""
    text = Path(f'/proc/{process}/smaps_rollup').read_text(encoding='ascii')
    return sum(int(size) for size in re.findall(r'Private_\w+:\s+(\d+) kB', text)) / 1000.0


def measure_worlds() -> None:
    """Print what the viewers of as many worlds see, each by a rosbots-view of its own."""
    with ExitStack() as stack:
        viewers, numbers = [], []
        for _ in range(WORLDS):
            process = stack.enter_context(
                subprocess.Popen(
                    [sys.executable, '-m', 'rosbots_description.cli.view', str(ROBOT), '--no-open'],
                    stderr=subprocess.PIPE,
                    text=True,
                )
            )
            stack.callback(process.terminate)
            numbers.append(process.pid)
            assert process.stderr is not None
            addresses = (ADDRESS.match(line) for line in process.stderr)
            viewers.append(Viewer(next(match[1] for match in addresses if match)))
            stack.enter_context(viewers[-1].browser)
        before = [cpu_seconds(number) for number in numbers]
        begin = time.monotonic()
        watch_all(viewers, 'rosbots', drives=True)
        passed = time.monotonic() - begin
        used = [
            100.0 * (cpu_seconds(number) - one) / passed
            for number, one in zip(numbers, before, strict=True)
        ]
        print(
            f'a world with its page: {statistics.median(used):.0f} % of a core, '
            f'{statistics.median(map(megabytes, numbers)):.0f} MB'
        )
        tell(f'{WORLDS} worlds with a viewer each', viewers)


def measure_students() -> None:
    """Print what the viewers of as many student.launch see, each with a ROS master of its own."""
    with ExitStack() as stack:
        logs = []
        for number in range(WORLDS):
            student = launched(
                f'student{number}',
                *('-p', str(free_port()), 'rosbots_description', 'student.launch'),
                *('student:=0', f'first_port:={free_port()}'),
            )
            stack.enter_context(student)
            logs.append(student.log)

        def addresses() -> list[str]:
            found = (ADDRESS.search(log.read_text('utf-8', errors='replace')) for log in logs)
            return [match[1] for match in found if match]

        wait_until(lambda: len(addresses()) == WORLDS, 'the pages of all students')
        viewers = [Viewer(address) for address in addresses()]
        for viewer in viewers:
            stack.enter_context(viewer.browser)
        watch_all(viewers, 'rosbots', drives=True)
        tell(f'{WORLDS} worlds with a ROS master and a viewer each', viewers)


def main() -> int:
    """Run each measurement in its own process; return the exit code."""
    run_in_new_process(measure_viewers)
    run_in_new_process(measure_worlds)
    run_in_new_process(measure_students)
    return 0


if __name__ == '__main__':
    sys.exit(main())
