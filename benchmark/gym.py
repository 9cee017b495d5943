#!/usr/bin/env python3
"""Measure environments of Gymnasium beside the same task in MuJoCo, and over ROS.

All loops run in processes of their own and alternate in short windows, so that ratios are of one
run; see environments.py. What the robots do differs from window to window, so the median of all
counts; beside it are the least and the greatest. The server is roscore, rosout and gzserver in
room.world at real time, paused except in the windows in which the task over ROS runs.
"""

from __future__ import annotations

import os
import sys
from collections import defaultdict
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from statistics import median

from article import robot_urdf
from environments import PER_CORE, EnvironmentLoop, cores
from server import Server, run_in_new_process

WINDOW = 1.0  # [s, wall]
ROUNDS = 8  # windows of each loop
PARTS = ('goal_physics', 'goal_scan', 'mujoco_physics', 'mujoco_scan')
KINDS = (
    'goal',
    'mujoco',
    'wander',
    'maze',
    'line',
    *PARTS,
    'reset',
    'vector',
    'core',
    'step',
    'pause',
)
PERIOD = 0.1  # [s, simulated] of a control step
RESET = 2.0  # [ms] at most
FASTER = 20.0  # least ratio to the task over ROS with pause and unpause, and to real time
OF_MUJOCO = 0.6  # least ratio to the same task in MuJoCo
LINEAR = 0.9  # least share of the speed of one process, or on one core, times the cores
ROOM = ('gazebo_ros', 'empty_world.launch', 'gui:=false', 'world_name:=worlds/room.world')


def measure() -> dict[str, list[float]]:
    """Return control steps per second in each window: of each kind, and of all cores ('cores').

    Starts a server, so it needs its own process.
    """
    windows: defaultdict[str, list[float]] = defaultdict(list)
    with ExitStack() as stack:
        server = stack.enter_context(Server(launch=ROOM))
        server.spawn_urdf('rosbots', robot_urdf(laser='true'))
        server.wait_simulated(1.0)
        loops = {kind: stack.enter_context(_started(kind)) for kind in KINDS}
        others = [stack.enter_context(_started('goal')) for _ in range(cores() - 1)]
        server.pause()
        for _ in range(ROUNDS):
            for kind, loop in loops.items():
                windows[kind].append(loop.speed(WINDOW))
            together = (loops['goal'], *others)
            for loop in together:
                loop.begin(WINDOW)
            windows['cores'].append(sum(loop.end() for loop in together))
    a_step_of_each = {'vector': PER_CORE * cores(), 'core': PER_CORE}
    return {
        kind: [speed * a_step_of_each.get(kind, 1) for speed in found]
        for kind, found in windows.items()
    }


def _started(kind: str) -> EnvironmentLoop:
    """Return a loop that is ready; two of them would disturb each other on one server."""
    loop = EnvironmentLoop(kind)
    loop.speed(0.0)
    return loop


def table(windows: Mapping[str, Sequence[float]], count: int) -> str:
    """Return the measured speeds on `count` cores as a table, with ratios and targets."""
    speeds = {kind: median(found) for kind, found in windows.items()}
    one, linear, vector = speeds['goal'], speeds['goal'] * count, speeds['vector']
    rows = [
        'environment                              steps/s  x real time  least-greatest',
        *(
            f'{name:38}{speeds[kind]:10.1f}{speeds[kind] * PERIOD:13.1f}'
            f'{min(windows[kind]):10.0f}-{max(windows[kind]):.0f}'
            for name, kind in (
                ('GoToGoal-v0, one process', 'goal'),
                ('Wander-v0', 'wander'),
                ('Maze-v0', 'maze'),
                ('FollowLine-v0', 'line'),
                ('the task of GoToGoal in MuJoCo', 'mujoco'),
                (f'GoToGoal-v0, a process on {count} cores', 'cores'),
                (f'GoToGoal-v0, make_vec of {PER_CORE} on one core', 'core'),
                (f'GoToGoal-v0, make_vec of {PER_CORE * count}', 'vector'),
                ('over ROS by /gazebo/step', 'step'),
                ('over ROS by unpause, wait, pause', 'pause'),
            )
        ),
        'part of a control step [ms]               ours     MuJoCo   quotient',
        *(
            _part(name, *pair)
            for name, *pair in (
                ('100 steps of physics', *_costs(windows, '_physics')),
                ('a scan of 361 rays', *_costs(windows, '_scan')),
                ('the rest: commands, reward, resets', *_rest(windows)),
            )
        ),
        _row('per core, x real time with 361 rays', one * PERIOD, FASTER),
        _row('/ the same task in MuJoCo', _quotient(windows, 'goal', 'mujoco'), OF_MUJOCO),
        _row('/ over ROS by unpause, wait, pause', one / speeds['pause'], FASTER),
        _row('/ over ROS by /gazebo/step', one / speeds['step']),
        _row('processes / linear', speeds['cores'] / linear, LINEAR),
        _row('make_vec / linear from one core', vector / (speeds['core'] * count), LINEAR),
        _row('make_vec / linear from one process', vector / linear),
        _row('reset [ms]', 1000.0 / speeds['reset'], RESET, at_most=True),
    ]
    return '\n'.join(rows)


def _quotient(windows: Mapping[str, Sequence[float]], one: str, other: str) -> float:
    """Return the median of the quotients of two kinds, round by round."""
    return median(a / b for a, b in zip(windows[one], windows[other], strict=True))


def _costs(windows: Mapping[str, Sequence[float]], part: str) -> tuple[float, float]:
    """Return the time of a part of a control step, ours and MuJoCo's [ms]."""
    ours, theirs = (1000.0 / median(windows[f'{whose}{part}']) for whose in ('goal', 'mujoco'))
    return ours, theirs


def _rest(windows: Mapping[str, Sequence[float]]) -> tuple[float, float]:
    """Return the time of a control step without physics and scan, ours and MuJoCo's [ms]."""
    whole, *parts = (_costs(windows, part) for part in ('', '_physics', '_scan'))
    ours, theirs = (whole[k] - sum(part[k] for part in parts) for k in (0, 1))
    return ours, theirs


def _part(name: str, ours: float, theirs: float) -> str:
    return f'{name:38}{ours:10.2f}{theirs:11.2f}{ours / theirs:11.2f}'


def _row(name: str, value: float, target: float | None = None, at_most: bool = False) -> str:
    row = f'{name:38}{value:10.2f}'
    if target is None:
        return row
    met = value <= target if at_most else value >= target
    bound = 'at most' if at_most else 'at least'
    return f'{row}  ({"met" if met else "NOT met"}: {bound} {target:g})'


def main() -> int:
    """Print the table; return the exit code."""
    print(table(run_in_new_process(measure), cores()))
    (load,) = os.getloadavg()[:1]
    print(f'load of the machine, mean of the last minute: {load:.1f} on {cores()} cores')
    return 0


if __name__ == '__main__':
    sys.exit(main())
