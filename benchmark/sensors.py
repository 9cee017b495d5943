#!/usr/bin/env python3
"""Measure the cost of sensors in the whole server, and compare it with Gazebo's.

Scene and robot are those of the recordings: seven shapes, and a laser of 720 rays at 40 Hz with
noise. Gazebo was measured on another machine, idle otherwise. Targets are scaled by the slowdown
of the bare PyBullet loop between both machines. The best of several windows counts, since other
load can only add.
"""

from __future__ import annotations

import math
import sys
import time
from contextlib import ExitStack
from random import Random

import rospy
from article import ROOT
from geometry_msgs.msg import Twist, Vector3
from reader import Reader
from real_time import slowdown
from server import Server, run_in_new_process, wait_until

RECORDED = ROOT / 'test' / 'data' / 'gazebo'
ROBOT = RECORDED / 'sensors' / 'robots' / 'laser_noise.urdf'
WINDOW = 3.0  # [s, wall]
ROUNDS = 4
RATE, CAMERA_RATE = 40.0, 30.0  # [Hz]
SHAPES, ROBOTS = 200, 5
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


def best(server: Server, *topics: str, rate: float = RATE) -> tuple[float, float, float]:
    """Return the lowest cost, the highest speed and share of messages of several windows.

    Args:
        topics: to which one node subscribes.
        rate: of all their messages together [Hz, simulated].
    """
    with ExitStack() as stack:
        reader = stack.enter_context(Reader(*topics)) if topics else None
        server.wait_simulated(1.0)
        costs, speeds, arrived = zip(
            *(window(server, reader, rate) for _ in range(ROUNDS)), strict=True
        )
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
        print(
            f'a subscriber adds {added:.1f} ms/s, scaled {added / slower:.1f} '
            f'(target {MOST_ADDED:g}: {_verdict(added <= MOST_ADDED * slower)}; Gazebo 40-55); '
            f'{arrived:.0%} of the scans received'
        )
        server.unthrottle()
        idle, (_, speed, arrived) = best(server)[1], best(server, '/scan')
        print(
            f'unthrottled, no subscriber: real-time factor {idle:.1f}, '
            f'Gazebo {GAZEBO_SPEED["no subscriber"]}'
        )
        print(
            f'unthrottled, subscribed: real-time factor {speed:.1f}, scaled {speed * slower:.1f} '
            f'(target {LEAST_SPEED:g}: '
            f'{_verdict(speed * slower >= LEAST_SPEED)}; Gazebo {GAZEBO_SPEED["subscribed"]}); '
            f'{arrived:.0%} of the scans received (Gazebo 80-93 %)'
        )


def measure_crowd(slower: float) -> None:
    """Print the processor time of the same laser among many shapes.

    Args:
        slower: as in `measure_laser`.
    """
    with Server() as server:
        draw = Random(1)
        server.spawn_urdf('crowd', static_shapes(draw, SHAPES))
        server.spawn_urdf('bot', ROBOT.read_text(encoding='utf-8'))
        added = -best(server)[0] + best(server, '/scan')[0]
        print(
            f'laser among {SHAPES} static shapes: a subscriber adds {added:.1f} ms/s, scaled '
            f'{added / slower:.1f} (target {MOST_ADDED:g}: '
            f'{_verdict(added <= MOST_ADDED * slower)})'
        )


def static_shapes(draw: Random, count: int) -> str:
    """Return a URDF of shapes that stand around the origin, 1.5 to 15 m away, in one model."""
    text = ''
    for number in range(count):
        way, distance = draw.uniform(-math.pi, math.pi), draw.uniform(1.5, 15.0)
        shape = (
            '<box size=".3 .4 1"/>',
            '<cylinder radius=".2" length="1"/>',
            '<sphere radius=".3"/>',
        )[number % 3]
        x, y, yaw = distance * math.cos(way), distance * math.sin(way), draw.uniform(0.0, 3.0)
        text += (
            f'<collision><origin xyz="{x} {y} .5" rpy="0 0 {yaw}"/><geometry>{shape}'
            '</geometry></collision>'
        )
    return (
        f'<robot name="crowd"><link name="link"><inertial><mass value="1"/><inertia ixx="1" '
        f'ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>{text}</link>'
        '<gazebo><static>true</static></gazebo></robot>'
    )


def measure_robots(slower: float) -> None:
    """Print the processor time of robots that drive in circles with a laser each.

    Args:
        slower: as in `measure_laser`.
    """
    text = (
        (ROBOT.parent / 'skid4_laser.urdf')
        .read_text(encoding='utf-8')
        .replace('<samples>720<', '<samples>360<')
        .replace('<update_rate>40<', '<update_rate>10<')
    )
    topics = [f'/scan{number}' for number in range(ROBOTS)]
    with Server(f'world_name:={RECORDED / "worlds" / "scene_a.world"}') as server:
        for number, topic in enumerate(topics):
            server.spawn_urdf(
                f'bot{number}', text.replace('>/scan<', f'>{topic}<'), x=-1.5 * number - 1.0
            )
        drive = rospy.Publisher('/cmd_vel', Twist, queue_size=1)
        wait_until(drive.get_num_connections, 'a robot')
        drive.publish(Twist(linear=Vector3(0.2, 0.0, 0.0), angular=Vector3(0.0, 0.0, 0.5)))
        cost, speed, arrived = best(server, *topics, rate=10.0 * ROBOTS)
        added = cost - best(server)[0]
        print(
            f'{ROBOTS} driving robots with 360 rays at 10 Hz: subscribers add {added:.1f} ms/s, '
            f'scaled {added / slower:.1f}, to a total of {cost:.0f}; real-time factor '
            f'{speed:.3f} (target 1: {_verdict(speed > 0.99)}); {arrived:.0%} of the scans '
            'received'
        )


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
        cost, speed, arrived = best(server, '/camera1/image_raw', rate=CAMERA_RATE)
        added = cost - idle
        print(
            f'camera {size}: a subscriber adds {added:.0f} ms of processor time per simulated '
            f'second, scaled {added / slower:.0f} (target for 320x240: '
            f'{MOST_OF_CAMERA:g}; Gazebo 1270-1350), real-time factor {speed:.3f}; '
            f'{arrived:.0%} of the images received (Gazebo 58-96 %)'
        )
        server.unthrottle()
        _, speed, arrived = best(server, '/camera1/image_raw', rate=CAMERA_RATE)
        print(
            f'camera {size}, unthrottled: real-time factor {speed:.1f}, {arrived:.0%} of '
            'the images received (Gazebo 15-21, 3-5 %)'
        )


def _verdict(met: bool) -> str:
    return 'met' if met else 'NOT met'


def main() -> int:
    """Run each measurement in its own process; return the exit code."""
    slower = slowdown()
    print(f'slowdown against the machine of Gazebo, by the bare PyBullet loop: {slower:.2f}')
    for measure in (measure_laser, measure_crowd, measure_robots):
        run_in_new_process(measure, slower)
    for robot, size in (('camera_320', '320x240'), ('camera_640', '640x480')):
        run_in_new_process(measure_camera, robot, size, slower)
    return 0


if __name__ == '__main__':
    sys.exit(main())
