#!/usr/bin/env python3
"""Measure the whole server at its default rate: its processor time, its haste and its size.

Processor time is compared with what Gazebo needed, times how much slower the bare PyBullet loop
runs now than it ran beside Gazebo. The least of several windows counts, and the soonest of several
starts: whatever else the machine does can only add. The rest is printed as it is.
"""

from __future__ import annotations

import statistics
import sys
import time
from contextlib import closing
from dataclasses import replace
from itertools import cycle

import recorded
import rospy
import rosservice
from article import FORWARD, ROOT, robot_spec
from gazebo_msgs.srv import GetLinkState, GetModelState, GetWorldProperties
from lateness import STEP, report
from loops import Loop
from server import Server, in_a_process_of_its_own

from rosbots_description.sim.core.transforms import Pose as SpawnPose
from rosbots_description.sim.physics.crash_sandbox import CrashSandbox
from rosbots_description.sim.runtime.world import World

WINDOW = 3.0  # [s, wall]
ROUNDS = 4
GAZEBO_CPU = {0: 10.0, 1: 13.0}  # [% of a core] by robots, /clock at every step
GAZEBO_MEMORY = {1: 174.0, 20: 343.0}  # [MB] by robots
GAZEBO_BARE = 25_300.0  # steps/s of the bare loop beside Gazebo, one robot driving
SPAWNS = 20
COMMANDS = 50
SLOW = 0.1  # [m/s] of the commands whose effect is awaited
RAMP = 0.2  # [s] in which the robot has come to that speed, or to rest
HAMMER_RATE, HAMMER_SECONDS = 200.0, 10.0  # [Hz], [s, wall] of service calls
CALLS = 50  # of each service
SLOWEST = 5  # services to be named
# What an empty request would change for what comes after.
NOT_CALLED = {'spawn_urdf_model', 'spawn_sdf_model', 'set_physics_properties', 'pause_physics',
              'reset_world', 'reset_simulation', 'step'}
WHEEL = 'robot0::wheel_left_link'


def measure_cost(frequency: int, slowness: float) -> tuple[float, float]:
    """Print what the server costs with /clock at that rate [Hz]; return the times to start [s].

    Args:
        slowness: of this machine, against the one that Gazebo was measured on.
    """
    arguments = ('use_clock_frequency:=true', f'pub_clock_frequency:={frequency}')
    with Server(*arguments) as server:
        for robots, share in GAZEBO_CPU.items():
            if robots:
                server.spawn()
                server.drive()
            server.rounded(2.0)
            used, factor = _least_share(server)
            scaled = share * slowness
            print(f'/clock {frequency:4} Hz, robots driving {robots}: {used:5.1f} % of a core, '
                  f'Gazebo {share:g} % then, {scaled:.1f} % here: {used / scaled:.2f} of it; '
                  f'real-time factor {factor:.4f}')
        print(f'memory with 1 robot: {server.memory():.0f} MB (Gazebo {GAZEBO_MEMORY[1]:.0f})')
        return _start(server)


def _start(server: Server) -> tuple[float, float]:
    """Return when the spawn service was there, and when its process began, after roslaunch [s]."""
    return server.seconds_to_spawn_service, server.seconds_to_process


def _least_share(server: Server) -> tuple[float, float]:
    """Return the least share of a core [%] and the real-time factor over all windows."""
    shares, begin, simulated = [], time.monotonic(), server.simulated()
    for _ in range(ROUNDS):
        used, before = server.cpu_seconds(), time.monotonic()
        time.sleep(WINDOW)
        shares.append(100.0 * (server.cpu_seconds() - used) / (time.monotonic() - before))
    return min(shares), (server.simulated() - simulated) / (time.monotonic() - begin)


def measure_answers() -> tuple[float, float]:
    """Print how soon robots are spawned and services answer; return the times to start."""
    with Server() as server:
        print(f'first spawn of the robot, its trial included: {1000 * server.spawn():.1f} ms')
        print_times('spawn of the robot', [server.spawn() for _ in range(SPAWNS)], '100 ms')
        print(f'memory with {SPAWNS + 1} robots: {server.memory():.0f} MB '
              f'(Gazebo with 20: {GAZEBO_MEMORY[20]:.0f})')
        _print_services()
        return _start(server)


def measure_start(roscore: bool) -> tuple[float, float]:
    """Return the times to start [s], beside a roscore or without one."""
    with Server(roscore=roscore) as server:
        return _start(server)


def measure_trials() -> None:
    """Print how long the steps of a spawn take for robots that are new to the server."""
    robot = robot_spec()
    compiling, trials, adding = [], [], []
    with closing(World()) as world, CrashSandbox(world.engine) as sandbox:
        for i in range(SPAWNS):
            other = replace(robot.joints[0], damping=0.01 * i)
            begin = time.monotonic()
            model = world.compile(replace(robot, joints=(other, *robot.joints[1:])))
            compiled = time.monotonic()
            sandbox.require(model, world.physics)
            tried = time.monotonic()
            world.spawn(model, f'robot{i}', SpawnPose((0.0, 10.0 * i, 0.5)))
            adding.append(time.monotonic() - tried)
            trials.append(tried - compiled)
            compiling.append(compiled - begin)
    print_times('compiling a robot that is new', compiling, '20 ms')
    print_times('its trial in the crash sandbox', trials, '150 ms')
    print_times('adding it, while the world waits', adding, '20 ms')


def print_times(what: str, times: list[float], aim: str) -> None:
    """Print the middle and the longest of some times [s]."""
    print(f'{what}: median {1000 * statistics.median(times):.1f} ms, '
          f'longest of {len(times)} {1000 * max(times):.1f} ms (aim {aim})')


def _print_services() -> None:
    """Print how long services take to answer while robots stand."""
    times = []
    for name in rosservice.get_service_list(node='/gazebo'):
        if name.rsplit('/', 1)[1] in NOT_CALLED:
            continue
        call = rospy.ServiceProxy(name, rosservice.get_service_class_by_name(name), persistent=True)
        call()
        taken = []
        for _ in range(CALLS):
            begin = time.perf_counter()
            call()
            taken.append(time.perf_counter() - begin)
        call.close()
        times.append((statistics.median(taken), name))
    for median, name in sorted(times, reverse=True)[:SLOWEST]:
        print(f'{name:37} answers in {1000 * median:.2f} ms (median)')


def measure_promptness() -> None:
    """Print how soon commands reach wheels, and how late steps are while services are called."""
    with Server(launch=[str(ROOT / 'benchmark' / 'recorded.launch')]) as server:
        server.spawn()
        server.rounded(2.0)
        sent = _command(server)
        server.drive(FORWARD)
        begin, before = server.simulated(), _processor_time()
        rate = _hammer()
        end, after = server.simulated(), _processor_time()
    record = recorded.read()
    print_times('command to wheel', [_target_after(one, record) - one for one in sent],
                'one period of 10 ms and 3 ms')
    late = report(record.steps[round(begin / STEP) : round(end / STEP)])
    print(f'steps late in the quietest 2 s, at {rate:.0f} calls/s: '
          + ', '.join(f'{share} {1000 * seconds:.2f} ms' for share, seconds in late.items())
          + ' (aim: p99 below 2 ms)')
    stolen, passed = (now - then for now, then in zip(after, before, strict=True))
    print(f'meanwhile the host of this machine took {stolen / passed:.1%} of its processors away')


def _processor_time() -> tuple[int, int]:
    """Return how much of all processors' time a host took away, and all of it, in one unit."""
    with open('/proc/stat', encoding='ascii') as stat:
        times = [int(field) for field in stat.readline().split()[1:9]]
    return times[-1], sum(times)


def _command(server: Server) -> list[float]:
    """Command a standing robot to drive, at all phases of its plugin's period; return when [s]."""
    sent = []
    for i in range(COMMANDS):
        server.drive(0.0)
        server.rounded(RAMP + 0.01 * i / COMMANDS)
        sent.append(time.monotonic())
        server.drive(SLOW)
        server.rounded(RAMP)
    return sent


def _target_after(moment: float, record: recorded.Record) -> float:
    """Return when the wheel got its first new target after a moment [s, monotonic]."""
    return next(when for when, _ in record.targets if when > moment)


def _hammer() -> float:
    """Call services at a steady rate; return at which it was [Hz]."""
    model = rospy.ServiceProxy('/gazebo/get_model_state', GetModelState)
    link = rospy.ServiceProxy('/gazebo/get_link_state', GetLinkState)
    world = rospy.ServiceProxy('/gazebo/get_world_properties', GetWorldProperties)
    requests = cycle((lambda: model('robot0', ''), lambda: link(WHEEL, ''), world))
    begin = time.monotonic()
    for i in range(int(HAMMER_RATE * HAMMER_SECONDS)):
        next(requests)()
        time.sleep(max(0.0, begin + (i + 1) / HAMMER_RATE - time.monotonic()))
    return HAMMER_RATE * HAMMER_SECONDS / (time.monotonic() - begin)


def slowness() -> float:
    """Return how much slower the bare loop runs here and now than beside Gazebo."""
    with Loop('bare', 1, driving=True) as loop:
        loop.speed(0.0)  # until it is ready
        return GAZEBO_BARE / max(loop.speed(0.5) for _ in range(2 * ROUNDS))


def _print_start(of_what: str, starts: list[tuple[float, float]], slower: float) -> None:
    """Print how soon the spawn service was there after roslaunch."""
    up, began = min(starts)
    print(f'spawn service up {up:.2f} s after roslaunch, which took {began:.2f} s of it to start '
          f'{of_what}; {up / slower:.2f} s by the bare loop where Gazebo was measured '
          '(aim 1.1 s; Gazebo 0.9 to 1.5 s)')


def main() -> int:
    """Measure each in a process of its own; return the exit code."""
    slower = slowness()
    print(f'bare PyBullet takes {slower:.2f} times as long as it did beside Gazebo')
    starts = [
        in_a_process_of_its_own(measure_cost, 100, slower),
        in_a_process_of_its_own(measure_cost, 1000, slower),
        in_a_process_of_its_own(measure_answers),
    ]
    _print_start('a master', starts, slower)
    starts = [in_a_process_of_its_own(measure_start, True) for _ in range(ROUNDS)]
    _print_start('the server where a roscore runs, as in the tutorial', starts, slower)
    in_a_process_of_its_own(measure_trials)
    in_a_process_of_its_own(measure_promptness)
    return 0


if __name__ == '__main__':
    sys.exit(main())
