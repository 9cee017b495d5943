#!/usr/bin/env python3
"""Environments, each in its own process, measured in control steps per second over windows.

    goal     rosbots/GoToGoal-v0: the article's robot in a room, with a scan of 361 rays
    reset    the same; only its resets, and each counts as a step
    vector   `PER_CORE` of them for each core, by gymnasium.make_vec; a step of all is one
    core     `PER_CORE` of them in the same way, all on one core, with their parent
    step     the same task over ROS, by scripts/ros_environment.py and /gazebo/step; without its
             contact sensor, which would take two thirds of the time
    pause    the same between unpause_physics and pause_physics
    mujoco   the same task in MuJoCo; see mujoco_room.py
    wander, maze, line      the other tasks, driven at random
    goal_physics, goal_scan, mujoco_physics, mujoco_scan      only this part of a control step

A control step is 0.1 s of simulated time, or 100 steps of the engine. The argument is the kind.
Each line on standard input is a window [s, wall]; the answer is the number of steps per second.
"""

from __future__ import annotations

import contextlib
import logging
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from functools import partial
from itertools import count
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from article import ROOT
from numpy.typing import NDArray
from windows import Steps, WindowedLoop, answer

if TYPE_CHECKING:
    from mujoco_room import MujocoGoToGoal

TASKS = 'rosbots_description.gym:rosbots/'
TASK = f'{TASKS}GoToGoal-v0'
PER_CORE = 4  # environments in parallel, as a step of all waits for the slowest
ENGINE_STEPS = 100  # of 1 ms in a control step
_TURN = np.array((0.0, 0.3), np.float32)  # action in which only a part is measured


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0))


class EnvironmentLoop(WindowedLoop):
    """One of the loops, in a child process that waits between windows."""

    def __init__(self, kind: str) -> None:
        """Start the process."""
        super().__init__(__file__, kind, 'cmd_vel:=/part2_cmr/cmd_vel')


def steer(goal: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the actions (..., 2) that turn towards the goal and drive, for goals (..., 3)."""
    return np.stack([np.maximum(goal[..., 1], 0.0), np.clip(2.0 * goal[..., 2], -1.0, 1.0)], -1)


def _episodes(
    environment: gymnasium.Env[Any, Any] | MujocoGoToGoal, drive: Callable[[Any], Any]
) -> Steps:
    """Return a function that drives one episode after the other.

    Args:
        environment: as Gymnasium's.
        drive: returns the action for an observation.
    """
    seeds = count()
    seen, _ = environment.reset(seed=next(seeds))

    def step(steps: int) -> None:
        nonlocal seen
        for _ in range(steps):
            seen, _, terminated, truncated, _ = environment.step(drive(seen))
            if terminated or truncated:
                seen, _ = environment.reset(seed=next(seeds))

    return step


@contextlib.contextmanager
def goal() -> Iterator[Steps]:
    """Yield the step function of one environment without ROS."""
    with contextlib.closing(gymnasium.make(TASK)) as environment:
        yield _episodes(environment, _towards_goal)


def _towards_goal(seen: dict[str, NDArray[np.float32]]) -> NDArray[np.float32]:
    return steer(seen['goal'])


@contextlib.contextmanager
def task(name: str) -> Iterator[Steps]:
    """Yield the step function of another task, driven at random."""
    draw = np.random.default_rng(0)
    with contextlib.closing(gymnasium.make(f'{TASKS}{name}-v0')) as environment:
        yield _episodes(environment, lambda _: draw.uniform((0.0, -1.0), 1.0).astype(np.float32))


@contextlib.contextmanager
def mujoco() -> Iterator[Steps]:
    """Yield the step function of the same task in MuJoCo."""
    from mujoco_room import MujocoGoToGoal

    yield _episodes(MujocoGoToGoal(), _towards_goal)


@contextlib.contextmanager
def part(kind: str) -> Iterator[Steps]:
    """Yield a function that makes only one part of so many control steps, while the robot turns."""
    if kind.startswith('mujoco'):
        from mujoco_room import MujocoGoToGoal

        room = MujocoGoToGoal()
        room.reset(0)
        room.step(_TURN)
        physics, scan = room.advance, room.scan
    else:
        environment: Any = gymnasium.make(TASK).unwrapped
        environment.reset(seed=0)
        environment.step(_TURN)
        physics = partial(environment.world.run, ENGINE_STEPS)
        scan = environment.robot.sensor('laser').read
    work = physics if kind.endswith('physics') else scan
    yield lambda steps: [work() for _ in range(steps)]


@contextlib.contextmanager
def reset() -> Iterator[Steps]:
    """Yield a function that resets the environment so many times."""
    with contextlib.closing(gymnasium.make(TASK)) as environment:
        seeds = count()
        yield lambda times: [environment.reset(seed=next(seeds)) for _ in range(times)]


@contextlib.contextmanager
def vector(one_core: bool) -> Iterator[Steps]:
    """Yield the step function of environments in parallel, each in its process."""
    if one_core:
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    with contextlib.closing(gymnasium.make_vec(TASK, PER_CORE * cores())) as environments:
        seen, _ = environments.reset(seed=0)

        def step(steps: int) -> None:
            nonlocal seen
            for _ in range(steps):
                seen, *_ = environments.step(steer(seen['goal']).astype(np.float32))

        yield step


@contextlib.contextmanager
def ros(exact: bool) -> Iterator[Steps]:
    """Yield the step function of the environment over ROS; the simulator must be running."""
    import rospy

    sys.path.append(str(ROOT / 'scripts'))
    from ros_environment import RosGoToGoal

    rospy.init_node('environment', anonymous=True, disable_signals=True)
    yield _episodes(
        gymnasium.wrappers.TimeLimit(RosGoToGoal(exact, bumper=False), 400), _towards_goal
    )
    rospy.signal_shutdown('measured')


def main() -> int:
    """Measure windows until the input ends; return the exit code."""
    logging.disable(logging.WARNING)
    kind = sys.argv[1]
    loops: dict[str, Callable[[], AbstractContextManager[Steps]]] = {
        'goal': goal,
        'reset': reset,
        'mujoco': mujoco,
        'vector': lambda: vector(one_core=False),
        'core': lambda: vector(one_core=True),
        'step': lambda: ros(exact=True),
        'pause': lambda: ros(exact=False),
        'wander': lambda: task('Wander'),
        'maze': lambda: task('Maze'),
        'line': lambda: task('FollowLine'),
    }
    with loops.get(kind, lambda: part(kind))() as step:
        answer(step)
    return 0


if __name__ == '__main__':
    sys.exit(main())
