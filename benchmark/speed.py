#!/usr/bin/env python3
"""Measure steps per wall second, beside a bare PyBullet loop in the same run.

The bare loop takes the article's URDF as it is (17 links) and does nothing but step. Ours does
everything the simulator does for a driving robot with nobody subscribed. The quotient of the two
does not depend on the machine; Gazebo's, measured once against the same bare loop, stands beside.
"""

import logging
import sys
import tempfile
import time
from collections.abc import Callable

from article import SETTLED, robot_spec, robot_urdf

from rosbots_description.sim.engine import pybullet
from rosbots_description.sim.pose import Pose
from rosbots_description.sim.silence import silent
from rosbots_description.sim.world import World
from rosbots_description.sim.worlds import add_empty_world

ROBOTS = (0, 1, 5, 10, 20)
GAZEBO = {0: 0.072, 1: 0.87, 5: 0.98, 10: 1.04, 20: 1.05}  # its steps / those of the bare loop
SECONDS = 2.0  # [s, wall] for each measurement
DISTANCE = 3.0  # [m] between robots


def measure(step: Callable[[int], None], batch: int) -> float:
    """Return steps per second."""
    steps, begin = 0, time.perf_counter()
    while (elapsed := time.perf_counter() - begin) < SECONDS:
        step(batch)
        steps += batch
    return steps / elapsed


def bare(robots: int) -> float:
    """Return the steps per second of PyBullet alone, robots driving."""
    client = pybullet.connect(pybullet.DIRECT)
    try:
        pybullet.setGravity(0, 0, -9.8, client)
        pybullet.setTimeStep(0.001, client)
        ground = pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=client)
        pybullet.createMultiBody(0, ground, physicsClientId=client)
        with tempfile.NamedTemporaryFile('w', suffix='.urdf') as file:
            file.write(robot_urdf())
            file.flush()
            for i in range(robots):
                place = [0.0, DISTANCE * i, 0.2]
                with silent():
                    body = pybullet.loadURDF(file.name, place, physicsClientId=client)
                for joint in range(pybullet.getNumJoints(body, client)):
                    if pybullet.getJointInfo(body, joint, client)[2] == pybullet.JOINT_REVOLUTE:
                        pybullet.setJointMotorControl2(
                            body, joint, pybullet.VELOCITY_CONTROL, targetVelocity=1.9, force=5.0,
                            physicsClientId=client,
                        )

        def step(count: int) -> None:
            for _ in range(count):
                pybullet.stepSimulation(client)

        step(SETTLED)
        return measure(step, 100 if robots else 10_000)
    finally:
        pybullet.disconnect(client)


def ours(robots: int) -> float:
    """Return the steps per second of the simulator, robots driving."""
    world = World()
    try:
        add_empty_world(world)
        spec = robot_spec()
        for i in range(robots):
            model = world.spawn(spec, f'robot{i}', Pose((0.0, DISTANCE * i, 0.5)))
            model.plugins[0].command(0.5, 0.0)
        world.run(SETTLED)
        return measure(world.run, 100 if robots else 10_000)
    finally:
        world.close()


def main() -> int:
    """Print the table; return the exit code."""
    logging.disable(logging.WARNING)
    print('robots driving   bare PyBullet       ours   ours/bare   Gazebo/bare   ours/Gazebo')
    for robots in ROBOTS:
        reference, own = bare(robots), ours(robots)
        ratio = own / reference
        print(f'{robots:14} {reference:11.0f} /s {own:8.0f} /s {ratio:11.2f} '
              f'{GAZEBO[robots]:13.3f} {ratio / GAZEBO[robots]:13.2f}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
