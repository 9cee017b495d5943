#!/usr/bin/env python3
"""Measure the whole server at its default rate: processor time, latency and memory.

Processor time is compared with Gazebo's, scaled by the slowdown of the bare PyBullet loop against
the machine on which Gazebo was measured. The best of several windows and of several starts counts,
since other load can only add. All other figures are not scaled.
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
from server import Server, run_in_new_process

from rosbots_description.sim.core.transforms import Pose as SpawnPose
from rosbots_description.sim.physics import CrashSandbox, make_engine
from rosbots_description.sim.runtime.world import World

WINDOW = 3.0  # [s, wall]
ROUNDS = 4
GAZEBO_CPU = {0: 10.0, 1: 13.0}  # [% of a core] by robots, /clock at every step
GAZEBO_MEMORY = {1: 174.0, 20: 343.0}  # [MB] by robots
GAZEBO_BARE = 25_300.0  # steps/s of the bare loop beside Gazebo, one robot driving
SPAWNS = 20
COMMANDS = 50
SLOW = 0.1  # [m/s] commanded where latency is measured
RAMP = 0.2  # [s] until the robot has this speed, or is at rest
CALL_RATE, CALL_SECONDS = 200.0, 10.0  # [Hz], [s, wall] of service calls
CALLS = 50  # of each service
SLOWEST = 5  # services to print
# Services that would change the world of later measurements.
NOT_CALLED = {
    'spawn_urdf_model',
    'spawn_sdf_model',
    'set_physics_properties',
    'pause_physics',
    'reset_world',
    'reset_simulation',
    'step',
}
WHEEL = 'robot0::wheel_left_link'


def measure_cost(frequency: int, slowdown: float) -> tuple[float, float]:
    """Print the server's processor time with /clock at `frequency` [Hz]; return its start times.

    Args:
        slowdown: of this machine, relative to the one on which Gazebo was measured.
    """
    arguments = ('use_clock_frequency:=true', f'pub_clock_frequency:={frequency}')
    with Server(*arguments) as server:
        for robots, share in GAZEBO_CPU.items():
            if robots:
                server.spawn()
                server.drive()
            server.wait_simulated(2.0)
            used, factor = _least_share(server)
            scaled = share * slowdown
            print(
                f'/clock {frequency:4} Hz, robots driving {robots}: {used:5.1f} % of a core, '
                f'Gazebo {share:g} %, scaled to this machine {scaled:.1f} %: '
                f'ratio {used / scaled:.2f}; real-time factor {factor:.4f}'
            )
        print(f'memory with 1 robot: {server.memory():.0f} MB (Gazebo {GAZEBO_MEMORY[1]:.0f})')
        return _start(server)


def _start(server: Server) -> tuple[float, float]:
    """Return the times from roslaunch to the spawn service and to the start of its process [s]."""
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
    """Print the durations of spawns and service calls; return the start times [s]."""
    with Server() as server:
        print(f'first spawn of the robot, crash sandbox included: {1000 * server.spawn():.1f} ms')
        print_times('spawn of the robot', [server.spawn() for _ in range(SPAWNS)], '100 ms')
        print(
            f'memory with {SPAWNS + 1} robots: {server.memory():.0f} MB '
            f'(Gazebo with 20: {GAZEBO_MEMORY[20]:.0f})'
        )
        _print_services()
        return _start(server)


def measure_start(roscore: bool) -> tuple[float, float]:
    """Return the start times [s] with a running roscore or without one."""
    with Server(roscore=roscore) as server:
        return _start(server)


def measure_trials() -> None:
    """Print the durations of the phases of a spawn, for models new to the server."""
    robot = robot_spec()
    compiling, trials, adding = [], [], []
    with closing(World()) as world, CrashSandbox(world.engine, make_engine) as sandbox:
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
    print_times('compile a new model', compiling, '20 ms')
    print_times('test it in the crash sandbox', trials, '150 ms')
    print_times('add it to the world (blocks the loop)', adding, '20 ms')


def print_times(what: str, times: list[float], aim: str) -> None:
    """Print the median and the maximum of durations [s]."""
    print(
        f'{what}: median {1000 * statistics.median(times):.1f} ms, '
        f'maximum of {len(times)} {1000 * max(times):.1f} ms (target {aim})'
    )


def _print_services() -> None:
    """Print the response times of the slowest services while robots stand."""
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
    """Print the latency from command to wheel, and the lateness of steps under service calls."""
    with Server(launch=[str(ROOT / 'benchmark' / 'recorded.launch')]) as server:
        server.spawn()
        server.wait_simulated(2.0)
        sent = _command(server)
        server.drive(FORWARD)
        begin, before = server.simulated(), _processor_time()
        rate = _call_services()
        end, after = server.simulated(), _processor_time()
    record = recorded.read()
    print_times(
        'command to wheel',
        [_target_after(one, record) - one for one in sent],
        'one period of 10 ms + 3 ms',
    )
    late = report(record.steps[round(begin / STEP) : round(end / STEP)])
    print(
        f'lateness of steps in the best 2 s, at {rate:.0f} calls/s: '
        + ', '.join(f'{share} {1000 * seconds:.2f} ms' for share, seconds in late.items())
        + ' (target: p99 below 2 ms)'
    )
    stolen, passed = (now - then for now, then in zip(after, before, strict=True))
    print(f'steal time of this virtual machine meanwhile: {stolen / passed:.1%}')


def _processor_time() -> tuple[int, int]:
    """Return the steal time of all processors and their total time, in the same unit."""
    with open('/proc/stat', encoding='ascii') as stat:
        times = [int(field) for field in stat.readline().split()[1:9]]
    return times[-1], sum(times)


def _command(server: Server) -> list[float]:
    """Send drive commands spread over the plugin's period; return their times [s, monotonic]."""
    sent = []
    for i in range(COMMANDS):
        server.drive(0.0)
        server.wait_simulated(RAMP + 0.01 * i / COMMANDS)
        sent.append(time.monotonic())
        server.drive(SLOW)
        server.wait_simulated(RAMP)
    return sent


def _target_after(moment: float, record: recorded.Record) -> float:
    """Return the time of the first new wheel target after `moment` [s, monotonic]."""
    return next(when for when, _ in record.targets if when > moment)


def _call_services() -> float:
    """Call services at `CALL_RATE`; return the actual rate [Hz]."""
    model = rospy.ServiceProxy('/gazebo/get_model_state', GetModelState)
    link = rospy.ServiceProxy('/gazebo/get_link_state', GetLinkState)
    world = rospy.ServiceProxy('/gazebo/get_world_properties', GetWorldProperties)
    requests = cycle((lambda: model('robot0', ''), lambda: link(WHEEL, ''), world))
    begin = time.monotonic()
    for i in range(int(CALL_RATE * CALL_SECONDS)):
        next(requests)()
        time.sleep(max(0.0, begin + (i + 1) / CALL_RATE - time.monotonic()))
    return CALL_RATE * CALL_SECONDS / (time.monotonic() - begin)


def slowdown() -> float:
    """Return the slowdown of the bare loop against the machine where Gazebo was measured."""
    with Loop('bare', 1, driving=True) as loop:
        loop.speed(0.0)  # until it is ready
        return GAZEBO_BARE / max(loop.speed(0.5) for _ in range(2 * ROUNDS))


def _print_start(of_what: str, starts: list[tuple[float, float]], slower: float) -> None:
    """Print the time from roslaunch to the spawn service."""
    up, began = min(starts)
    print(
        f'spawn service up {up:.2f} s after roslaunch, of which {began:.2f} s to start '
        f'{of_what}; scaled to the machine of Gazebo {up / slower:.2f} s '
        '(target 1.1 s; Gazebo 0.9 to 1.5 s)'
    )


def main() -> int:
    """Run each measurement in its own process; return the exit code."""
    slower = slowdown()
    print(f'slowdown against the machine of Gazebo, by the bare PyBullet loop: {slower:.2f}')
    starts = [
        run_in_new_process(measure_cost, 100, slower),
        run_in_new_process(measure_cost, 1000, slower),
        run_in_new_process(measure_answers),
    ]
    _print_start('a master', starts, slower)
    starts = [run_in_new_process(measure_start, True) for _ in range(ROUNDS)]
    _print_start('the server, with a running roscore as in the tutorial', starts, slower)
    run_in_new_process(measure_trials)
    run_in_new_process(measure_promptness)
    return 0


if __name__ == '__main__':
    sys.exit(main())
