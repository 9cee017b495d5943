#!/usr/bin/env python3
"""Measure the effect of engine settings on motion and cost; the table of doc/physics.md.

For each setting: the largest relative differences of the article's robot from Gazebo (steady
speeds, times to 90 %), the errors of the scenes in test/support/scenes.py, and the cost of a step
with the robot driving, relative to the default setting in the same run.
"""

import logging
import sys
import time
from dataclasses import replace

from support import SETTLED, SPAWN_POSE, empty_world, robot_spec, urdf_spec
from support.motion import compare_drive
from support.recorded import load
from support.scenes import SCENES, SPEED, box, forward_speed

from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.physics.bullet.tuning import Tuning
from rosbots_description.sim.runtime.model import Model
from rosbots_description.sim.runtime.world import World

USUAL = Tuning()
SETTINGS = {
    'as is': USUAL,
    '50 iterations': Tuning(iterations=1.0),
    '20 iterations': Tuning(iterations=0.4),
    '8 iterations': Tuning(iterations=0.16),
    'cone': Tuning(friction_cone=True),
    'prisms': Tuning(exact_cylinders=False),
    'push 200/s': Tuning(push_out=200.0),
}
WIDTH = 22  # of the first column
SMALL = 0.2  # speeds below this are not compared [m/s or rad/s]
BATCH = 200  # steps between readings of the clock
ROUNDS = 100
TURNS = 3


def gazebo_errors(tuning: Tuning) -> tuple[float, float]:
    """Return the largest relative errors against Gazebo of steady speeds and times to 90 %."""
    speeds, times = [], []
    for command in load('article')['drives']:
        for one in compare_drive('article', command, tuning):
            if one.quantity in ('v', 'w') and abs(one.expected) > SMALL:
                speeds.append(abs(one.ours / one.expected - 1.0))
            elif one.quantity.startswith('t90'):
                times.append(abs(one.ours / one.expected - 1.0))
    return max(speeds), max(times)


def driven(world: World) -> Model:
    """Return the article's robot, driving at its steady speed."""
    model = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
    model.plugin('diff_drive').command(SPEED, 0.0)
    world.run(SETTLED)
    return model


def lay_box(world: World) -> None:
    """Replace the ground plane by a box of 100 m."""
    world.delete('ground_plane')
    slab = replace(urdf_spec(box('slab', (100.0, 100.0, 1.0), 1.0)), static=True)
    world.spawn(slab, 'ground_plane', Pose((0.0, 0.0, -0.5)))


def quickest_batch(world: World) -> float:
    """Return the shortest duration of a batch [s]; other load can only add to it."""
    best = float('inf')
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        world.run(BATCH)
        best = min(best, time.perf_counter() - begin)
    return best


def costs() -> dict[str, float]:
    """Return the cost of a step with the robot driving, relative to the default setting.

    The settings alternate; the quickest batch of each counts.
    """
    best = dict.fromkeys(SETTINGS, float('inf'))
    for _ in range(TURNS):
        for name, tuning in SETTINGS.items():
            with empty_world(tuning) as world:
                driven(world)
                best[name] = min(best[name], quickest_batch(world))
    return {name: value / best['as is'] for name, value in best.items()}


def compare_grounds() -> str:
    """Return how a box instead of the ground plane changes the cost of a step and the speed."""
    best, speeds = [float('inf')] * 2, [0.0] * 2
    for _ in range(TURNS):
        for i in (0, 1):
            with empty_world() as world:
                if i:
                    lay_box(world)
                speeds[i] = forward_speed(driven(world))
                best[i] = min(best[i], quickest_batch(world))
    return (
        f'box of 100 m as ground: cost of a step x {best[1] / best[0]:.2f}, '
        f'speed {speeds[1] / speeds[0] - 1.0:+.2%}'
    )


def main() -> int:
    """Print the table, one column for each setting; return the exit code."""
    logging.disable(logging.WARNING)
    print(' ' * WIDTH + ''.join(f'{name:>11}' for name in SETTINGS))
    multiples = costs()
    errors = {name: gazebo_errors(tuning) for name, tuning in SETTINGS.items()}
    print(f'{"cost of a step":{WIDTH}}' + ''.join(f'{multiples[n]:11.2f}' for n in SETTINGS))
    for i, what in enumerate(('speeds vs. Gazebo', 't90 vs. Gazebo')):
        print(f'{what:{WIDTH}}' + ''.join(f'{errors[n][i]:11.2%}' for n in SETTINGS))
    for what, scene in SCENES.items():
        print(f'{what:{WIDTH}}', end='')
        for tuning in SETTINGS.values():
            print(f'{scene(tuning):11.5f}', end='', flush=True)
        print()
    print(compare_grounds())
    return 0


if __name__ == '__main__':
    sys.exit(main())
