#!/usr/bin/env python3
"""Measure what bodies at rest cost: processor time per step, and quotients of it in one run.

Thirty boxes at rest, beside bare PyBullet, which never lets them sleep; the worlds of this package
with nothing moving; the article's robot that turns in them, beside the empty world; and what one
look at a world with it costs each reader, among 300 static boxes beside the empty world.
"""

from __future__ import annotations

import logging
import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from statistics import median

from article import ROOT, robot_spec
from support import empty_world, urdf_spec
from support.scenes import box

from rosbots_description.ros_api.views.frames import ShownFrames
from rosbots_description.ros_api.views.visuals import ShownMarkers
from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.physics.bullet.client import pybullet
from rosbots_description.sim.public import World as PublicWorld
from rosbots_description.sim.rendering.scene import SceneMirror
from rosbots_description.sim.runtime import ShownWorld
from rosbots_description.sim.runtime.world import World

WORLDS = ('shapes', 'room', 'rooms', 'maze')
PLACES = [(5.0 + 0.5 * (i % 6), 0.5 * (i // 6), 0.1) for i in range(30)]  # of the boxes [m]
SETTLED = 2500  # steps until all sleep, or the robot turns steadily
WINDOW = 500  # steps
STATIC = 300  # boxes around a robot that is looked at
LOOKS = 200
CRATE = box('crate', (1.0, 1.0, 1.0), 1.0).replace(
    '</link>', '<visual><geometry><box size="1 1 1"/></geometry></visual></link>'
)
ROUNDS = 7

Steps = Callable[[int], object]


def windows(step: Steps) -> list[float]:
    """Return the processor time of a step in several windows [us]."""
    found = []
    for _ in range(ROUNDS):
        begin = time.process_time()
        step(WINDOW)
        found.append((time.process_time() - begin) / WINDOW * 1e6)
    return found


@contextmanager
def bare_boxes() -> Iterator[Steps]:
    """Yield the step function of PyBullet alone with the boxes, awake."""
    client = pybullet.connect(pybullet.DIRECT)
    pybullet.setGravity(0, 0, -9.8, client)
    pybullet.setTimeStep(0.001, client)
    pybullet.setPhysicsEngineParameter(numSolverIterations=9, physicsClientId=client)
    ground = pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=client)
    pybullet.createMultiBody(0, ground, physicsClientId=client)
    for place in PLACES:
        shape = pybullet.createCollisionShape(
            pybullet.GEOM_BOX, halfExtents=[0.1] * 3, physicsClientId=client
        )
        pybullet.createMultiBody(1, shape, basePosition=place, physicsClientId=client)

    def step(count: int) -> None:
        for _ in range(count):
            pybullet.stepSimulation(client)

    step(SETTLED)
    yield step
    pybullet.disconnect(client)


@contextmanager
def world_named(name: str) -> Iterator[World]:
    """Yield a world of this package, the empty one, or that with the boxes."""
    if name in WORLDS:
        path = ROOT / 'src' / 'rosbots_description' / 'worlds' / f'{name}.world'
        with PublicWorld.from_file(path) as world:
            yield world
        return
    with empty_world() as world:
        for i, place in enumerate(PLACES if name == 'boxes' else ()):
            world.spawn(urdf_spec(box('link', (0.2, 0.2, 0.2), 1.0)), f'box{i}', Pose(place))
        yield world


def turning(name: str) -> list[float]:
    """Return the processor time of a step while the article's robot turns among sleepers [us]."""
    with world_named(name) as world:
        robot = world.spawn(robot_spec(), 'robot', Pose((0.0, 0.0, 0.2)))
        robot.plugin('diff_drive').command(0.0, 1.0)
        world.run(SETTLED)
        return windows(world.run)


def readers(world: World) -> dict[str, Callable[[], object]]:
    """Return what a look of each reader of a world's changes is."""
    page, mirror = ShownWorld(world), SceneMirror(world)
    markers, frames = ShownMarkers(world), ShownFrames(world)
    return {
        'the page': lambda: (page.change(), page.motion(0.0)),
        'a camera': lambda: (mirror.update(), mirror.poses()),
        'the markers of RViz': markers.changes,
        'the frames of gzclient': frames.changes,
    }


def looks(static: int) -> dict[str, list[float]]:
    """Return the processor time of a look, by readers, among static boxes [us]."""
    times: dict[str, list[float]] = {}
    with world_named('empty') as world:
        robot = world.spawn(robot_spec(), 'robot', Pose((0.0, 0.0, 0.2)))
        robot.plugin('diff_drive').command(0.0, 1.0)
        crate = replace(urdf_spec(CRATE), static=True)
        for i in range(static):
            world.spawn(crate, f'crate{i}', Pose((5.0 + 2.0 * (i % 20), 2.0 * (i // 20), 0.5)))
        every = readers(world)
        for _ in range(LOOKS):
            for name, look in every.items():
                world.run(1)
                begin = time.process_time()
                look()
                times.setdefault(name, []).append(1e6 * (time.process_time() - begin))
    return times


def report(what: str, times: list[float], beside: float) -> None:
    """Print a row: least, median and greatest time [us], and the quotient of medians."""
    numbers = ''.join(f'{x:9.2f}' for x in (min(times), median(times), max(times)))
    print(f'{what:32}{numbers}{median(times) / beside:9.3f}', flush=True)


def main() -> int:
    """Print the table; return the exit code."""
    logging.disable(logging.WARNING)
    print(f'{"us of processor time per step":32}      min   median      max quotient')
    with bare_boxes() as step:
        bare = windows(step)
    report('thirty boxes, bare PyBullet', bare, median(bare))
    for name in ('boxes', *WORLDS):
        with world_named(name) as world:
            world.run(SETTLED)
            report(f'{name}, nothing moves', windows(world.run), median(bare))
    alone = turning('empty')
    for name in ('empty', *WORLDS, 'boxes'):
        report(f'{name}, the robot turns', turning(name), median(alone))
    print(f'{"us of processor time per look":32}      min   median      max quotient')
    beside, among = looks(0), looks(STATIC)
    for name in among:
        report(f'{name}, the robot turns', beside[name], median(beside[name]))
        report(f'{name}, among {STATIC}', among[name], median(beside[name]))
    print(f'load of the machine: {os.getloadavg()[0]:.1f}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
