#!/usr/bin/env python3
"""Step loops without ROS, each in its own process, measured over windows of time.

    bare    PyBullet alone with the original URDF of the article (17 links); only steps
    engine  our engine alone, with the simulator's description of the robot (3 links)
    world   the simulator without ROS: engine, clock, plugins; no output has a reader
    merged  as bare, with fixed links merged, and with another robot if one is named

Arguments: the kind, the number of robots, 1 if they drive, and the robot. Each line on standard
input is a window [s, wall]; the answer is the number of steps per second.
"""

from __future__ import annotations

import contextlib
import logging
import sys
import tempfile
from collections.abc import Callable, Iterator

from article import driven_world, kind_urdf
from windows import Steps, WindowedLoop, answer

from rosbots_description.sim.physics.bullet.client import pybullet
from rosbots_description.sim.physics.bullet.silence import silent

STANDING = 1000  # steps until spawned robots stand on the ground
DISTANCE = 3.0  # [m] between robots
WHEEL_SPEED = 1.9  # [rad/s] of a robot that drives at 0.5 m/s
WHEEL_TORQUE = 5.0  # [N m]


class Loop(WindowedLoop):
    """One of the loops, in a child process that waits between windows."""

    def __init__(self, kind: str, robots: int, driving: bool, robot: str = 'article') -> None:
        """Start the process; the first window begins when the robots stand."""
        super().__init__(__file__, kind, str(robots), str(int(driving)), robot)


@contextlib.contextmanager
def bare(robots: int, driving: bool, robot: str, flags: int = 0) -> Iterator[Steps]:
    """Yield the step function of PyBullet alone."""
    client = pybullet.connect(pybullet.DIRECT)
    pybullet.setGravity(0, 0, -9.8, client)
    pybullet.setTimeStep(0.001, client)
    ground = pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=client)
    pybullet.createMultiBody(0, ground, physicsClientId=client)
    with tempfile.NamedTemporaryFile('w', suffix='.urdf') as file, silent():
        file.write(kind_urdf(robot))
        file.flush()
        bodies = [
            pybullet.loadURDF(
                file.name, [0.0, DISTANCE * i, 0.2], flags=flags, physicsClientId=client
            )
            for i in range(robots)
        ]

    def step(count: int) -> None:
        for _ in range(count):
            pybullet.stepSimulation(client)

    step(STANDING)  # motors started in the air overturn this robot
    for body in bodies if driving else ():
        _drive(body, client)
    yield step
    pybullet.disconnect(client)


def _drive(body: int, client: int) -> None:
    for joint in range(pybullet.getNumJoints(body, client)):
        if pybullet.getJointInfo(body, joint, client)[2] == pybullet.JOINT_REVOLUTE:
            pybullet.setJointMotorControl2(
                body,
                joint,
                pybullet.VELOCITY_CONTROL,
                targetVelocity=WHEEL_SPEED,
                force=WHEEL_TORQUE,
                physicsClientId=client,
            )


def merged(robots: int, driving: bool, robot: str) -> contextlib.AbstractContextManager[Steps]:
    """Return the same with fixed links merged, as Gazebo and the simulator do."""
    return bare(robots, driving, robot, pybullet.URDF_MERGE_FIXED_LINKS)


@contextlib.contextmanager
def world(robots: int, driving: bool, _robot: str) -> Iterator[Steps]:
    """Yield the step function of the simulator without ROS."""
    with driven_world(robots, DISTANCE, driving) as made:
        made.run(STANDING)
        yield made.run


@contextlib.contextmanager
def engine(robots: int, driving: bool, _robot: str) -> Iterator[Steps]:
    """Yield the step function of our engine, with the motor targets that the plugins set."""
    with driven_world(robots, DISTANCE, driving) as made:
        made.run(STANDING)
        yield made.engine.step


def main() -> int:
    """Measure windows until the input ends; return the exit code."""
    logging.disable(logging.WARNING)
    kind, robots, driving, robot = sys.argv[1:]
    loops: dict[str, Callable[[int, bool, str], contextlib.AbstractContextManager[Steps]]]
    loops = {'bare': bare, 'engine': engine, 'world': world, 'merged': merged}
    with loops[kind](int(robots), driving == '1', robot) as step:
        answer(step)
    return 0


if __name__ == '__main__':
    sys.exit(main())
