#!/usr/bin/env python3
"""Measure what sensors cost the whole server, beside what they cost Gazebo.

The scene and the robot are those in which Gazebo was recorded: seven shapes and a laser of 720 rays
at 40 Hz, with noise. Gazebo's figures are those of its own machine, undisturbed. What is aimed at
is scaled by how many times slower the bare PyBullet loop runs here than it ran beside Gazebo. The
least of several windows counts: whatever else the machine does can only add.
"""

from __future__ import annotations

import sys
import time
from contextlib import ExitStack

from article import ROOT
from reader import Reader
from real_time import slowness
from server import Server, in_a_process_of_its_own

RECORDED = ROOT / 'test' / 'data' / 'gazebo'
ROBOT = RECORDED / 'sensors' / 'robots' / 'laser_noise.urdf'
WINDOW = 3.0  # [s, wall]
ROUNDS = 4
RATE, CAMERA_RATE = 40.0, 30.0  # [Hz]
MOST_OF_CAMERA = 500.0  # [ms of processor time per simulated second], a third of Gazebo's
MOST_ADDED = 30.0  # [ms of processor time per simulated second] for a reader
LEAST_SPEED = 40.0  # times real time, with a reader
# Of Gazebo, three runs: [ms of processor time per simulated second] and times real time.
GAZEBO = {'no sensor': '155-170', 'nobody reads': '175-192', 'read': '197-245'}
GAZEBO_SPEED = {'nobody reads': '22-27', 'read': '14-20'}


def window(server: Server, reader: Reader | None, rate: float) -> tuple[float, float, float]:
    """Return processor time [ms per simulated s], times real time, and share of messages."""
    messages = reader.messages() if reader else 0
    used, begin, simulated = server.cpu_seconds(), time.monotonic(), server.simulated()
    time.sleep(WINDOW)
    end, passed = time.monotonic(), server.simulated() - simulated
    cost = 1000.0 * (server.cpu_seconds() - used) / passed
    arrived = (reader.messages() - messages) / (rate * passed) if reader else 0.0
    return cost, passed / (end - begin), arrived


def best(server: Server, topic: str = '', rate: float = RATE) -> tuple[float, float, float]:
    """Return the least cost, the greatest speed and the share of messages of several windows."""
    with ExitStack() as stack:
        reader = stack.enter_context(Reader(topic)) if topic else None
        server.rounded(1.0)
        costs, speeds, arrived = zip(
            *(window(server, reader, rate) for _ in range(ROUNDS)), strict=True)
    return min(costs), max(speeds), max(arrived)


def measure_laser(slower: float) -> None:
    """Print what a laser costs, and how fast it lets the server run.

    Args:
        slower: how many times as long as beside Gazebo the bare loop takes here.
    """
    world = RECORDED / 'worlds' / 'scene_a.world'
    with Server(f'world_name:={world}') as server:
        costs = {'no sensor': best(server)[0]}
        server.bring('bot', ROBOT.read_text(encoding='utf-8'))
        costs['nobody reads'] = best(server)[0]
        costs['read'], _, arrived = best(server, '/scan')
        for case, cost in costs.items():
            print(f'laser, {case:12}: {cost:6.1f} ms per simulated second, Gazebo {GAZEBO[case]}')
        added = costs['read'] - costs['nobody reads']
        print(f'a reader adds {added:.1f} ms/s, {added / slower:.1f} where Gazebo was measured '
              f'(aim {MOST_ADDED:g}: {_verdict(added <= MOST_ADDED * slower)}; Gazebo 40-55); '
              f'{arrived:.0%} of the scans arrive')
        server.unthrottle()
        idle, (_, speed, arrived) = best(server)[1], best(server, '/scan')
        print(f'as fast as it can, nobody reads: {idle:.1f} times real time, '
              f'Gazebo {GAZEBO_SPEED["nobody reads"]}')
        print(f'as fast as it can, read: {speed:.1f} times real time, {speed * slower:.1f} where '
              f'Gazebo was measured (aim {LEAST_SPEED:g}: '
              f'{_verdict(speed * slower >= LEAST_SPEED)}; Gazebo {GAZEBO_SPEED["read"]}); '
              f'{arrived:.0%} of the scans arrive (Gazebo 80-93 %)')


def measure_camera(robot: str, size: str, slower: float) -> None:
    """Print what a camera at 30 Hz costs, its process included, beside a robot that drives.

    Args:
        robot: the recorded robot that has it.
        size: of its pictures, e.g. '320x240'.
        slower: as `measure_laser`.
    """
    world = RECORDED / 'worlds' / 'scene_a.world'
    with Server(f'world_name:={world}') as server:
        text = (ROBOT.parent / f'{robot}.urdf').read_text(encoding='utf-8')
        server.bring('bot', text, x=1.2)
        server.spawn()
        server.drive(-0.1)
        idle = best(server)[0]
        cost, speed, arrived = best(server, '/camera1/image_raw', CAMERA_RATE)
        added = cost - idle
        print(f'camera {size}: a reader adds {added:.0f} ms of processor time per simulated '
              f'second, {added / slower:.0f} where Gazebo was measured (aim for 320x240: '
              f'{MOST_OF_CAMERA:g}; Gazebo 1270-1350), at {speed:.3f} times real time; '
              f'{arrived:.0%} of the pictures arrive (Gazebo 58-96 %)')
        server.unthrottle()
        _, speed, arrived = best(server, '/camera1/image_raw', CAMERA_RATE)
        print(f'camera {size}, as fast as it can: {speed:.1f} times real time, {arrived:.0%} of '
              'the pictures arrive (Gazebo 15-21, 3-5 %)')


def _verdict(met: bool) -> str:
    return 'met' if met else 'NOT met'


def main() -> int:
    """Measure each in a process of its own; return the exit code."""
    slower = slowness()
    print(f'bare PyBullet takes {slower:.2f} times as long as it did beside Gazebo')
    in_a_process_of_its_own(measure_laser, slower)
    for robot, size in (('camera_320', '320x240'), ('camera_640', '640x480')):
        in_a_process_of_its_own(measure_camera, robot, size, slower)
    return 0


if __name__ == '__main__':
    sys.exit(main())
