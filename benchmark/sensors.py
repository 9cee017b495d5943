#!/usr/bin/env python3
"""Measure the cost of sensors in the whole server, and compare it with Gazebo's.

Scene and robot are those of the recordings: seven shapes, and a laser of 720 rays at 40 Hz with
noise. Gazebo was measured on another machine, idle otherwise. Targets are scaled by the slowdown
of the bare PyBullet loop between both machines. The best of several windows counts, since other
load can only add.
"""

from __future__ import annotations

import sys
import time
from contextlib import ExitStack

from article import ROOT
from reader import Reader
from real_time import slowdown
from server import Server, run_in_new_process

RECORDED = ROOT / 'test' / 'data' / 'gazebo'
ROBOT = RECORDED / 'sensors' / 'robots' / 'laser_noise.urdf'
WINDOW = 3.0  # [s, wall]
ROUNDS = 4
RATE, CAMERA_RATE = 40.0, 30.0  # [Hz]
MOST_OF_CAMERA = 500.0  # [ms of processor time per simulated second], a third of Gazebo's
MOST_ADDED = 30.0  # [ms of processor time per simulated second] for a subscriber
LEAST_SPEED = 40.0  # real-time factor with a subscriber
# Gazebo, three runs: [ms of processor time per simulated second], and real-time factor.
GAZEBO = {'no sensor': '155-170', 'no subscriber': '175-192', 'subscribed': '197-245'}
GAZEBO_SPEED = {'no subscriber': '22-27', 'subscribed': '14-20'}


def window(server: Server, reader: Reader | None, rate: float) -> tuple[float, float, float]:
    """Return processor time [ms per simulated s], real-time factor, share of messages received."""
    messages = reader.messages() if reader else 0
    used, begin, simulated = server.cpu_seconds(), time.monotonic(), server.simulated()
    time.sleep(WINDOW)
    end, passed = time.monotonic(), server.simulated() - simulated
    cost = 1000.0 * (server.cpu_seconds() - used) / passed
    arrived = (reader.messages() - messages) / (rate * passed) if reader else 0.0
    return cost, passed / (end - begin), arrived


def best(server: Server, topic: str = '', rate: float = RATE) -> tuple[float, float, float]:
    """Return the lowest cost, the highest speed and share of messages of several windows."""
    with ExitStack() as stack:
        reader = stack.enter_context(Reader(topic)) if topic else None
        server.wait_simulated(1.0)
        costs, speeds, arrived = zip(
            *(window(server, reader, rate) for _ in range(ROUNDS)), strict=True)
    return min(costs), max(speeds), max(arrived)


def measure_laser(slower: float) -> None:
    """Print the processor time of a laser, and the highest real-time factor with it.

    Args:
        slower: slowdown of this machine against the one of Gazebo.
    """
    world = RECORDED / 'worlds' / 'scene_a.world'
    with Server(f'world_name:={world}') as server:
        costs = {'no sensor': best(server)[0]}
        server.spawn_urdf('bot', ROBOT.read_text(encoding='utf-8'))
        costs['no subscriber'] = best(server)[0]
        costs['subscribed'], _, arrived = best(server, '/scan')
        for case, cost in costs.items():
            print(f'laser, {case:13}: {cost:6.1f} ms per simulated second, Gazebo {GAZEBO[case]}')
        added = costs['subscribed'] - costs['no subscriber']
        print(f'a subscriber adds {added:.1f} ms/s, scaled {added / slower:.1f} '
              f'(target {MOST_ADDED:g}: {_verdict(added <= MOST_ADDED * slower)}; Gazebo 40-55); '
              f'{arrived:.0%} of the scans received')
        server.unthrottle()
        idle, (_, speed, arrived) = best(server)[1], best(server, '/scan')
        print(f'unthrottled, no subscriber: real-time factor {idle:.1f}, '
              f'Gazebo {GAZEBO_SPEED["no subscriber"]}')
        print(f'unthrottled, subscribed: real-time factor {speed:.1f}, scaled {speed * slower:.1f} '
              f'(target {LEAST_SPEED:g}: '
              f'{_verdict(speed * slower >= LEAST_SPEED)}; Gazebo {GAZEBO_SPEED["subscribed"]}); '
              f'{arrived:.0%} of the scans received (Gazebo 80-93 %)')


def measure_camera(robot: str, size: str, slower: float) -> None:
    """Print the processor time of a camera at 30 Hz, render process included; a robot drives by.

    Args:
        robot: name of the recorded robot with the camera.
        size: of its images, e.g. '320x240'.
        slower: as in `measure_laser`.
    """
    world = RECORDED / 'worlds' / 'scene_a.world'
    with Server(f'world_name:={world}') as server:
        text = (ROBOT.parent / f'{robot}.urdf').read_text(encoding='utf-8')
        server.spawn_urdf('bot', text, x=1.2)
        server.spawn()
        server.drive(-0.1)
        idle = best(server)[0]
        cost, speed, arrived = best(server, '/camera1/image_raw', CAMERA_RATE)
        added = cost - idle
        print(f'camera {size}: a subscriber adds {added:.0f} ms of processor time per simulated '
              f'second, scaled {added / slower:.0f} (target for 320x240: '
              f'{MOST_OF_CAMERA:g}; Gazebo 1270-1350), real-time factor {speed:.3f}; '
              f'{arrived:.0%} of the images received (Gazebo 58-96 %)')
        server.unthrottle()
        _, speed, arrived = best(server, '/camera1/image_raw', CAMERA_RATE)
        print(f'camera {size}, unthrottled: real-time factor {speed:.1f}, {arrived:.0%} of '
              'the images received (Gazebo 15-21, 3-5 %)')


def _verdict(met: bool) -> str:
    return 'met' if met else 'NOT met'


def main() -> int:
    """Run each measurement in its own process; return the exit code."""
    slower = slowdown()
    print(f'slowdown against the machine of Gazebo, by the bare PyBullet loop: {slower:.2f}')
    run_in_new_process(measure_laser, slower)
    for robot, size in (('camera_320', '320x240'), ('camera_640', '640x480')):
        run_in_new_process(measure_camera, robot, size, slower)
    return 0


if __name__ == '__main__':
    sys.exit(main())
