#!/usr/bin/env python3
"""Measure by how much robots of all kinds turn that are asked to drive straight on.

Small and large ones, on one caster and on two, with their weight over the axle and towards the
caster behind, at three speeds ahead and two back, with a limit to the acceleration and without;
each at four headings. Casters have mu 1, and each motor could lift the robot by the rim of its
wheel, so that many tip over. One that lands on its back is counted apart.
"""

from __future__ import annotations

import logging
import math
import os
import sys
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from typing import NamedTuple

from support import empty_world
from support.scenes import castered, drive

from rosbots_description.sim.pose import UP, rotate, yaw_of

SIZES = {0.2: 0.12, 5.0: 0.4, 50.0: 0.9}  # [m] by mass [kg]
ACCELERATIONS = (0.0, 1.0)  # [m/s^2]; 0: no limit
CASTERS = (1, 2)
REARS = (0.0, 0.2, 0.4)  # where the weight is, from the axle to the caster behind
SPEEDS = (0.2, 0.5, 1.0, -0.5, -1.0)  # [m/s]
HEADINGS = (0.0, 0.4, math.pi / 4.0, 1.3)  # [rad]
SECONDS = 20
MOST = 0.02  # [rad] the aim
UPRIGHT = 0.3  # cosine of the tilt beyond which a robot falls over
STEPS = 100  # between two looks at its tilt


class Robot(NamedTuple):
    """A robot and what it is asked for."""

    mass: float  # [kg]
    acceleration: float  # [m/s^2]
    casters: int
    rear: float
    speed: float  # [m/s]

    def __str__(self) -> str:
        limit = f'{self.acceleration:g} m/s2' if self.acceleration else 'no limit'
        return (f'{self.mass:4g} kg, casters: {self.casters}, weight at {self.rear:g}, '
                f'{self.speed:4g} m/s, {limit}')


def turned(robot: Robot) -> float | None:
    """Return by how much a robot turns at the worst heading [rad]; None if it falls over."""
    spec = castered(robot.mass, SIZES[robot.mass], robot.casters,
                    acceleration=robot.acceleration, rear=robot.rear)
    worst = 0.0
    for heading in HEADINGS:
        with empty_world() as world:
            model = drive(world, spec, 0, heading, robot.speed)
            for _ in range(1000 * SECONDS // STEPS):
                world.run(STEPS)
                if rotate(model.pose.orientation, UP)[2] < UPRIGHT:
                    return None
            yaw = yaw_of(model.pose.orientation)
            worst = max(worst, abs(math.remainder(yaw - heading, math.tau)))
    return worst


def main() -> int:
    """Print who turns by more than the aim; return the exit code."""
    logging.disable(logging.WARNING)
    robots = [Robot(*one) for one in product(SIZES, ACCELERATIONS, CASTERS, REARS, SPEEDS)]
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        found = dict(zip(robots, pool.map(turned, robots), strict=True))
    stand = sorted((rad, robot) for robot, rad in found.items() if rad is not None)
    for rad, robot in reversed(stand):
        if rad > MOST:
            print(f'{robot}: turns by {rad:.3f} rad in {SECONDS} s')
    for robot, rad in found.items():
        if rad is None:
            print(f'{robot}: falls over')
    good = sum(rad <= MOST for rad, _ in stand)
    print(f'{good} of {len(stand)} robots turn by less than {MOST:g} rad in {SECONDS} s straight '
          f'on, at any of {len(HEADINGS)} headings; half of them by less than '
          f'{stand[len(stand) // 2][0]:.4f} rad')
    return 0


if __name__ == '__main__':
    sys.exit(main())
