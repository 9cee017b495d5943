"""Speed of the server at nine commands, with one and twenty robots of three kinds of drive.

Each quotient is of two adjacent windows, one of the server and one of bare PyBullet with the same
robot, so that other load affects both. Gazebo's speed relative to that loop was measured with the
article's robot alone, with and without merging its fixed links, of which the other robots have one.
For them, the relation with merged links is an estimate.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from statistics import median
from typing import NamedTuple

from article import kind_urdf
from loops import Loop
from server import Server, run_in_new_process

COMMANDS = (  # [m/s], [rad/s]; the steering angle of the tricycle [rad]
    (0.05, 0.0), (0.1, 0.0), (0.3, 0.0), (0.5, 0.0), (1.0, 0.0),
    (0.3, 0.3), (0.5, 1.0), (0.0, 0.2), (0.0, 1.0),
)  # fmt: skip
KINDS = {  # words, spawn height [m], loop
    'article': ('two wheels and a caster', 0.5, 'bare'),
    'skid4': ('skid steer of four', 0.02, 'merged'),
    'tricycle': ('tricycle', 0.02, 'merged'),
}
# Gazebo's steps per second relative to the loop, by robots: one drives in both, twenty stand.
GAZEBO = {'bare': {1: 0.87, 20: 1.05}, 'merged': {1: 1.0 / 1.69, 20: 1.0 / 1.80}}
TARGETS = {1: 6.0, 20: 4.0}  # of the slowest command, relative to Gazebo
WINDOW = 0.3  # [s, wall]
ROUNDS = 5  # pairs of windows
SETTLE = 1.0  # [s, simulated] until robots drive at a steady speed


class Swept(NamedTuple):
    """Speeds at a command relative to Gazebo's, by pairs of windows, and the machine's load."""

    kind: str
    robots: int
    command: tuple[float, float]
    quotients: tuple[float, ...]
    steps: float  # of the server per second, median
    load: float  # average of a minute

    @property
    def middle(self) -> float:
        """Return the median quotient."""
        return median(self.quotients)


def sweep_all() -> list[Swept]:
    """Return all kinds, robots and commands, measured."""
    return [
        point
        for kind in KINDS
        for robots in TARGETS
        for point in run_in_new_process(sweep, kind, robots)
    ]


def sweep(kind: str, robots: int) -> list[Swept]:
    """Return all commands for one kind; starts a server, so it needs its own process."""
    found = []
    _, height, bare = KINDS[kind]
    with Server() as server, Loop(bare, robots, robots == 1, kind) as loop:
        server.unthrottle()
        for _ in range(robots):
            server.spawn(None if kind == 'article' else kind_urdf(kind), height)
        server.wait_simulated(SETTLE)
        loop.speed(0.0)  # wait until it is ready
        for command in COMMANDS:
            server.drive(*command)
            server.wait_simulated(SETTLE)
            server.pause()
            pairs = [(server.speed(WINDOW), loop.speed(WINDOW)) for _ in range(ROUNDS)]
            server.unpause()
            found.append(
                Swept(
                    kind,
                    robots,
                    command,
                    tuple(ours / (GAZEBO[bare][robots] * speed) for ours, speed in pairs),
                    median(ours for ours, _ in pairs),
                    os.getloadavg()[0],
                )
            )
    return found


def sweep_table(points: Sequence[Swept]) -> str:
    """Return the table, and the slowest command of each number of robots."""
    rows = [
        '',
        'times Gazebo at nine commands  robots   m/s rad/s     min  median     max  steps/s  load',
    ]
    for one in points:
        forward, turning = one.command
        rows.append(
            f'{KINDS[one.kind][0]:30} {one.robots:6} {forward:5g} {turning:5g} '
            f'{min(one.quotients):7.2f} {one.middle:7.2f} {max(one.quotients):7.2f} '
            f'{one.steps:8.0f} {one.load:5.1f}'
        )
    for robots, target in TARGETS.items():
        for kind, (words, *_) in KINDS.items():
            of_kind = [one for one in points if (one.kind, one.robots) == (kind, robots)]
            if of_kind:
                worst = min(of_kind, key=lambda one: one.middle)
                verdict = 'met' if worst.middle >= target else 'NOT met'
                forward, turning = worst.command
                rows.append(
                    f'slowest command, {robots} {words}: {worst.middle:.2f} times Gazebo '
                    f'at ({forward:g} m/s, {turning:g} rad/s) ({verdict}: {target:g})'
                )
    rows.append(
        "Gazebo: estimated from its speed relative to bare PyBullet with the article's "
        'robot on another machine'
    )
    return '\n'.join(rows)
