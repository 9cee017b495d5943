#!/usr/bin/env python3
"""Measure steps per wall second of the whole server, and of a bare PyBullet loop in the same run.

The server is roscore, rosout and gzserver, unthrottled, with /clock at each step and no other
subscriber; robots have the diff-drive plugin at 100 Hz. The bare loop, in its own process, steps
the original URDF of the article (17 links) and does nothing else; 'merged' is the same with fixed
links merged, as here. Gazebo's speed relative to that
loop was measured on another machine; times the speed of the bare loop here, it estimates Gazebo's
speed here.

The loops alternate in short windows. The best window of each counts, since other load can only slow
a loop down.

Then one and twenty robots of three kinds of drive get nine commands each (sweep.py); the slowest is
the headline.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

from article import OUTPUT
from loops import Loop
from plot import plot_speed
from reader import PER_SECOND, Reader, robot_topics
from server import STEPS_PER_SECOND, Server, run_in_new_process
from sweep import sweep_all, sweep_table

WINDOW = 0.5  # [s, wall]
ROUNDS = 10  # windows of each loop
SETTLE = 1.0  # [s, simulated] until spawned robots stand, or drive at a steady speed
GAZEBO_BARE = {20: 2150.0}  # steps/s of the bare loop on the machine of Gazebo, by robots
LOOPS = ('bare', 'merged', 'engine', 'world')
COLUMNS = (*LOOPS, 'server', 'read')
PICTURE = OUTPUT / 'speed.png'


@dataclass
class Case:
    """A number of robots, Gazebo's relative speed with them, and the measured speeds.

    From 5 robots on, Gazebo's speed relative to the bare loop was measured with standing robots.
    Driving did not change Gazebo's own speed with 20 robots, but it did change that of the bare
    loop. Therefore the robots of the bare loop stand in these cases.
    """

    robots: int
    driving: bool
    ratio: float | None = None  # Gazebo's steps per second / those of the bare loop
    target: float | None = None  # ours / Gazebo's
    target_read: float | None = None  # the same with odom, tf and joint_states subscribed
    bare_drives: bool = False
    best: dict[str, float] = field(default_factory=dict)  # column -> steps per second
    received: float = 0.0  # share of the messages that the subscriber received

    @property
    def name(self) -> str:
        """Return the name of the row in the table."""
        return f'{self.robots} {"driving" if self.driving else "idle"}' if self.robots else 'empty'

    @property
    def gazebo(self) -> float | None:
        """Return the estimated steps per second of Gazebo on this machine."""
        return self.ratio * self.best['bare'] if self.ratio else None

    def record(self, column: str, speed: float) -> None:
        """Keep the speed of a window if it is the best so far."""
        self.best[column] = max(speed, self.best.get(column, 0.0))


def cases() -> list[Case]:
    """Return the cases, by increasing number of robots."""
    return [
        Case(0, False, 0.072, target=7.0),
        Case(1, False, 0.58),
        Case(1, True, 0.87, target=5.5, target_read=1.2, bare_drives=True),
        Case(5, True, 0.98),
        Case(10, True, 1.04),
        Case(20, True, 1.05, target=3.2),
        Case(50, True),
    ]


def measure() -> list[Case]:
    """Return all cases, measured; starts a server, so it needs its own process."""
    measured = cases()
    with Server() as server:
        server.unthrottle()
        spawned = 0
        for case in measured:
            while spawned < case.robots:
                server.spawn()
                spawned += 1
            server.wait_simulated(SETTLE)
            if case.driving:
                server.drive()
                server.wait_simulated(SETTLE)
            server.pause()
            _measure_case(case, server)
            server.unpause()
    return measured


def _measure_case(case: Case, server: Server) -> None:
    """Measure the loops and the server in turn."""
    with ExitStack() as stack:
        loops = {}
        for kind in LOOPS:
            driving = case.bare_drives if kind in ('bare', 'merged') else case.driving
            loops[kind] = stack.enter_context(Loop(kind, case.robots, driving))
        for loop in loops.values():
            loop.speed(0.0)  # wait until it is ready
        for _ in range(ROUNDS):
            for kind, loop in loops.items():
                case.record(kind, loop.speed(WINDOW))
            case.record('server', server.speed(WINDOW))
            if case.robots:
                speed, received = _speed_read(server, case.robots)
                case.record('read', speed)
                case.received = max(case.received, received)


def _speed_read(server: Server, robots: int) -> tuple[float, float]:
    """Return the steps per second with a subscriber, and the share of messages it received."""
    with Reader(*robot_topics(robots)) as reader:
        before, simulated = reader.messages(), server.simulated()
        speed = server.speed(WINDOW)
        simulated = server.simulated() - simulated
        return speed, (reader.messages() - before) / (PER_SECOND * robots * simulated)


def table(measured: Sequence[Case]) -> str:
    """Return the measured cases as a table."""
    rows = [
        'robots        bare  merged  engine   world  server    read  Gazebo  server/bare  '
        'server/Gazebo        read/Gazebo received'
    ]
    for case in measured:
        speeds = [*(case.best.get(column) for column in COLUMNS), case.gazebo]
        row = f'{case.name:10}'
        row += ''.join(f'{speed:8.0f}' if speed else 8 * ' ' for speed in speeds)
        row += f'{case.best["server"] / case.best["bare"]:13.3f}'
        row += f'{_vs_gazebo(case, "server", case.target):>20}'
        row += f'{_vs_gazebo(case, "read", case.target_read):>18}'
        row += f'{case.received:9.0%}' if case.robots else ''
        rows.append(row)
    first = _first_standing([case for case in measured if case.driving])
    rows.append(
        'Gazebo: not measured here but estimated, from its speed relative to the bare loop '
        f'on another machine; from {first} robots on, measured with standing robots'
    )
    rows += [_real_time(case) for case in measured if case.robots in GAZEBO_BARE]
    return '\n'.join(rows)


def parts_table(measured: Sequence[Case]) -> str:
    """Return where the time of a step goes, and the limit: PyBullet alone with links merged."""
    rows = ['', 'us per step  engine  plugins, clock     ROS  messages   all  server/merged']
    for case in measured:
        took = {column: 1e6 / speed for column, speed in case.best.items() if speed}
        last = took.get('read', took['server'])
        parts = (
            took['engine'],
            took['world'] - took['engine'],
            took['server'] - took['world'],
            last - took['server'],
            last,
        )
        row = ''.join(
            f'{part:{width}.1f}' for part, width in zip(parts, (8, 16, 8, 10, 6), strict=True)
        )
        share = case.best['server'] / case.best['merged']
        rows.append(f'{case.name:11}{row}{share:15.2f}')
    return '\n'.join(rows)


def _real_time(case: Case) -> str:
    """Return the real-time factor with subscribers, here and scaled to the machine of Gazebo."""
    here = case.best['read'] / STEPS_PER_SECOND
    there = here * GAZEBO_BARE[case.robots] / case.best['bare']
    return (
        f'{case.name} with subscribers: real-time factor {here:.2f} here (target 1), '
        f'{there:.2f} scaled to the machine of Gazebo by the bare loop'
    )


def _vs_gazebo(case: Case, column: str, target: float | None) -> str:
    """Return the ratio to Gazebo's speed, and whether it meets the target."""
    if not case.gazebo or column not in case.best:
        return ''
    ratio = case.best[column] / case.gazebo
    verdict = f' ({"met" if ratio >= target else "NOT met"}: {target:g})' if target else ''
    return f'{ratio:.2f}{verdict}'


def draw(measured: Sequence[Case], path: Path) -> None:
    """Plot the speeds of driving robots."""
    shown = [case for case in measured if case.driving]
    standing = f'from {_first_standing(shown)} robots on, these stand'
    names = {
        'server': 'no subscriber',
        'read': 'odom, tf and joint_states subscribed',
        'bare': f'bare PyBullet, {standing}',
    }
    curves = {
        name: [(case.robots, case.best[column]) for case in shown] for column, name in names.items()
    }
    gazebo = (
        'Gazebo, no subscriber: estimated from its speed relative to\n'
        f'bare PyBullet on another machine; {standing}'
    )
    curves[gazebo] = [(case.robots, case.gazebo) for case in shown if case.gazebo]
    plot_speed(path, curves, estimated=gazebo)


def _first_standing(driving: Sequence[Case]) -> int:
    """Return the least number of robots for which those of the bare loop stand."""
    return min(case.robots for case in driving if not case.bare_drives)


def main() -> int:
    """Print the table and save the plot; return the exit code."""
    measured = run_in_new_process(measure)
    print(table(measured))
    print(parts_table(measured))
    print(sweep_table(sweep_all()))
    draw(measured, PICTURE)
    print(f'picture: {PICTURE}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
