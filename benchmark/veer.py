#!/usr/bin/env python3
"""Measure the heading drift of robots that drive straight, with friction pyramid and cone.

Robots: the article's, whose drift was recorded in Gazebo, and robots of 0.2, 5 and 50 kg with one
and two casters. Each drives at four headings; the worst counts.
"""

from __future__ import annotations

import logging
import math
import os
import sys
from concurrent.futures import ProcessPoolExecutor
from itertools import product

from support import SETTLED, SPAWN_POSE, empty_world, robot_spec
from support.scenes import HEADINGS, castered, drive

from rosbots_description.sim.core.transforms import Pose, from_rpy, yaw_of
from rosbots_description.sim.physics.bullet.tuning import Tuning

SIZES = {0.2: 0.12, 5.0: 0.4, 50.0: 0.9}  # [m] by mass [kg]
ARTICLE = "the article's"
ROBOTS = (ARTICLE, *product(SIZES, (1, 2)))
CONES = (False, True)
SPEED, SECONDS = 1.0, 20
GAZEBO = {ARTICLE: 0.42}  # [rad] in Gazebo, at the same speed and time


def heading_drift(case: tuple[str | tuple[float, int], bool]) -> float:
    """Return the drift of a robot at the worst heading [rad]."""
    robot, cone = case
    return max(
        abs(math.remainder(_yaw(robot, cone, heading) - heading, math.tau)) for heading in HEADINGS
    )


def _yaw(robot: str | tuple[float, int], cone: bool, heading: float) -> float:
    with empty_world(Tuning(friction_cone=cone)) as world:
        if not isinstance(robot, str):
            mass, casters = robot
            model = drive(world, castered(mass, SIZES[mass], casters), SECONDS, heading, SPEED)
            return yaw_of(model.pose.orientation)
        place = Pose(SPAWN_POSE.position, from_rpy(0.0, 0.0, heading))
        model = world.spawn(robot_spec(), 'robot', place)
        world.run(SETTLED)
        model.plugin('diff_drive').command(SPEED, 0.0)
        world.run(1000 * SECONDS)
        return yaw_of(model.pose.orientation)


def main() -> int:
    """Print the table; return the exit code."""
    logging.disable(logging.WARNING)
    cases = list(product(ROBOTS, CONES))
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        found = dict(zip(cases, pool.map(heading_drift, cases), strict=True))
    print(
        f'heading drift [rad] after {SECONDS} s at {SPEED:g} m/s, worst of {len(HEADINGS)} headings'
    )
    print(f'{"robot":24}{"pyramid":>10}{"cone":>10}{"Gazebo":>10}')
    for robot in ROBOTS:
        name = robot if isinstance(robot, str) else f'{robot[0]:g} kg, casters: {robot[1]}'
        gazebo = f'{GAZEBO[robot]:10.4f}' if robot in GAZEBO else ''
        print(f'{name:24}' + ''.join(f'{found[robot, cone]:10.4f}' for cone in CONES) + gazebo)
    return 0


if __name__ == '__main__':
    sys.exit(main())
