#!/usr/bin/env python3
"""Measure what the window in the browser costs the server, and how fast it shows what happens.

A client that decodes the page's connection takes the browser's place: what a browser draws is its
own affair. Each window of time with it is compared with one without, turn by turn, so that other
load adds to both; medians count.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from article import robot_urdf
from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import DeleteModel, SetModelState
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3
from server import PATIENCE, SYSTEM_TIME, USER_TIME, Server, run_in_new_process
from support.browser import Browser

WINDOW = 3.0  # [s, wall]
ROUNDS = 4
MOST_CPU = 5.0  # [% of a core] that a page adds to the server
LEAST_RATE = 20.0  # [Hz] at which bodies reach the page
LATEST = 200.0  # [ms] until models have come to the page, or gone from it
CHANGES = 10  # spawns of each model
BODIES = 100, 300
SPEED = 0.05  # [m/s] of bodies that float
BALL = """<robot name="ball"><link name="body"><inertial><mass value="1"/><inertia ixx=".001"
  ixy="0" ixz="0" iyy=".001" iyz="0" izz=".001"/></inertial><visual><geometry>
  <sphere radius=".05"/></geometry></visual></link><gazebo reference="body">
  <turnGravityOff>true</turnGravityOff></gazebo></robot>"""


class Window:
    """The process gzweb of a server, with the addresses of its page."""

    def __init__(self, *options: str) -> None:
        self._process = subprocess.Popen(
            ['rosrun', 'gazebo_ros', 'gzweb', '--port', '0', *options],
            stderr=subprocess.PIPE,
            text=True,
        )
        assert self._process.stderr is not None
        self.process = self._process.pid  # rosrun has become the program
        self.address = self._process.stderr.readline().split()[-1]
        self.viewing_address = self._process.stderr.readline().split()[-1]

    def __enter__(self) -> Window:
        return self

    def __exit__(self, *_exception: object) -> None:
        self._process.terminate()
        self._process.wait()

    def cpu_seconds(self) -> float:
        """Return its processor time so far [s]."""
        stat = Path(f'/proc/{self._process.pid}/stat').read_text(encoding='ascii')
        fields = stat.rsplit(')', 1)[1].split()
        return (int(fields[USER_TIME]) + int(fields[SYSTEM_TIME])) / os.sysconf('SC_CLK_TCK')


def share(server: Server, wait: Callable[[float], object]) -> tuple[float, float]:
    """Return the server's share of a core [%] and its real-time factor, within a window of time.

    Args:
        wait: for so many seconds.
    """
    used, begin, simulated = server.cpu_seconds(), time.monotonic(), server.simulated()
    wait(WINDOW)
    passed = time.monotonic() - begin
    return (
        100.0 * (server.cpu_seconds() - used) / passed,
        (server.simulated() - simulated) / passed,
    )


def measure_robot() -> None:
    """Print what a page that shows the driving robot costs the server, and what gzweb without one.

    The three cases take turns, so that other load is in all of them.
    """
    costs: dict[str, list[tuple[float, float]]] = {'no gzweb': [], 'no page': [], 'a page': []}
    with Server() as server:
        server.spawn()
        server.drive()
        server.wait_simulated(2.0)
        for _ in range(ROUNDS):
            costs['no gzweb'].append(share(server, time.sleep))
            with Window() as window:
                costs['no page'].append(share(server, time.sleep))
                with Browser(window.address) as browser:
                    browser.wait_until(lambda: has(browser, 'robot0'))
                    costs['a page'].append(share(server, browser.read))
    for case, found in costs.items():
        used, factor = (statistics.median(values) for values in zip(*found, strict=True))
        added = used - statistics.median(one for one, _ in costs['no gzweb'])
        print(
            f'the robot, {case:8}: {used:5.1f} % of a core ({added:+.1f}; target for a page '
            f'{MOST_CPU:g}), real-time factor {factor:.3f} (target 1.00)'
        )


def measure_changes() -> None:
    """Print how long after the call of a service a page has a model, and no longer has it."""
    with Server() as server, Window() as window, Browser(window.address) as browser:
        browser.wait_until(lambda: has(browser, 'ground_plane'))
        for name, text in (('ball', BALL), ('robot', robot_urdf())):
            measure_model(server, browser, name, text)


def measure_model(server: Server, browser: Browser, name: str, text: str) -> None:
    """Print that of one model, which is spawned and deleted several times."""
    delete = server.service('delete_model', DeleteModel)
    come, gone = [], []
    for _ in range(CHANGES):
        come.append(
            delay(browser, lambda: server.spawn_urdf(name, text), lambda: has(browser, name))
        )
        gone.append(delay(browser, lambda: delete(name), lambda: not has(browser, name)))
    for what, found in (('spawned', come), ('deleted', gone)):
        print(
            f'a {name} is {what} and a page shows that within {statistics.median(found):.0f} ms, '
            f'at most {max(found):.0f} (target {LATEST:g})'
        )


def delay(browser: Browser, act: Callable[[], object], condition: Callable[[], bool]) -> float:
    """Return the time from the beginning of an act until a page's condition holds [ms]."""
    begin = time.monotonic()
    act()
    while not condition():
        browser.read(0.001)
        if time.monotonic() > begin + PATIENCE:
            raise TimeoutError(f'not on the page within {PATIENCE:g} s')
    return 1000.0 * (time.monotonic() - begin)


def measure_bodies(count: int) -> None:
    """Print how often each of so many moving bodies reaches a page, and what that costs."""
    with Server() as server, Window() as window:
        place = server.service('set_model_state', SetModelState)
        for number in range(count):
            server.spawn_urdf(f'ball{number}', BALL)
            height = Pose(
                Point(0.0, 0.2 * (number % 20), 1.0 + 0.2 * (number // 20)),
                Quaternion(0.0, 0.0, 0.0, 1.0),
            )
            place(
                ModelState(
                    f'ball{number}',
                    height,
                    Twist(Vector3(SPEED, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)),
                    '',
                )
            )
        idle = statistics.median(share(server, time.sleep)[0] for _ in range(ROUNDS))
        with Browser(window.address) as browser:
            browser.wait_until(lambda: has(browser, f'ball{count - 1}'))
            rates, shares, factors, own = [], [], [], []
            for _ in range(ROUNDS):
                browser.messages.clear()
                before = window.cpu_seconds()
                used, factor = share(server, browser.read)
                own.append(100.0 * (window.cpu_seconds() - before) / WINDOW)
                moves = sum(message['type'] == 'SetPositionMessage' for message in browser.messages)
                rates.append(moves / count / WINDOW)
                shares.append(used)
                factors.append(factor)
    rate = statistics.median(rates)
    print(
        f'{count} moving bodies reach the page at {rate:.1f} Hz (target for {BODIES[0]}: '
        f'{LEAST_RATE:g}); the server uses {statistics.median(shares):.1f} % of a core '
        f'({statistics.median(shares) - idle:+.1f}), gzweb {statistics.median(own):.1f} %, '
        f'real-time factor {statistics.median(factors):.3f}'
    )


def has(browser: Browser, model: str) -> bool:
    """Tell whether a page has been given a model with all its links."""
    return any(node.startswith(f'/models/{model}/') for node in browser.nodes)


def main() -> int:
    """Run each measurement in its own process; return the exit code."""
    run_in_new_process(measure_robot)
    run_in_new_process(measure_changes)
    for count in BODIES:
        run_in_new_process(measure_bodies, count)
    return 0


if __name__ == '__main__':
    sys.exit(main())
