#!/usr/bin/env python3
"""Measure steps per wall second of the whole server, beside a bare PyBullet loop in the same run.

The server is roscore, rosout and gzserver, as fast as it can, with /clock at each step, nobody else
subscribed; robots carry the diff-drive plugin at 100 Hz. The bare loop, in a process of its own,
takes the article's URDF as it is (17 links) and does nothing but step. Gazebo was once measured
beside that loop; the bare loop's speed times the quotient of then is what Gazebo would do here.

The loops take turns in short windows and the best of each counts: whatever else the machine does
can only slow a loop down.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

from article import OUTPUT
from loops import Loop
from plot import plot_speed
from reader import PER_SECOND, Reader, robot_topics
from server import Server, in_a_process_of_its_own

WINDOW = 0.5  # [s, wall]
ROUNDS = 10  # windows of each loop
SETTLE = 1.0  # [s, simulated] until robots that were spawned stand, or drive steadily
STEPS_PER_SECOND = 1000.0  # at real time
GAZEBO_BARE = {20: 2150.0}  # steps/s of the bare loop beside Gazebo, by robots
LOOPS = ('bare', 'engine', 'world')
COLUMNS = (*LOOPS, 'server', 'read')
PICTURE = OUTPUT / 'speed.png'


@dataclass
class Case:
    """So many robots, what Gazebo made of them, and what was measured.

    Gazebo's quotient beside 5 robots and more is that of standing robots; its own speed was the
    same with 20 that drove, but the bare loop's was not. So the bare loop's robots stand there.
    """

    robots: int
    driving: bool
    quotient: float | None = None  # Gazebo's steps per second / those of the bare loop
    aim: float | None = None  # ours / Gazebo's
    aim_read: float | None = None  # the same with odom, tf and joint_states subscribed
    bare_drives: bool = False
    best: dict[str, float] = field(default_factory=dict)  # column -> steps per second
    arrived: float = 0.0  # share of the messages that reached their reader

    @property
    def name(self) -> str:
        """Return what a row of the table is called."""
        return f'{self.robots} {"driving" if self.driving else "idle"}' if self.robots else 'empty'

    @property
    def gazebo(self) -> float | None:
        """Return the steps per second that Gazebo would make here."""
        return self.quotient * self.best['bare'] if self.quotient else None

    def saw(self, column: str, speed: float) -> None:
        """Take note of a window."""
        self.best[column] = max(speed, self.best.get(column, 0.0))


def cases() -> list[Case]:
    """Return what is measured, in an order in which robots are only added."""
    return [
        Case(0, False, 0.072, aim=7.0),
        Case(1, False, 0.58),
        Case(1, True, 0.87, aim=5.5, aim_read=1.2, bare_drives=True),
        Case(5, True, 0.98),
        Case(10, True, 1.04),
        Case(20, True, 1.05, aim=3.2),
        Case(50, True),
    ]


def measure() -> list[Case]:
    """Return all cases, measured; starts a server and needs a process of its own."""
    measured = cases()
    with Server() as server:
        server.unthrottle()
        spawned = 0
        for case in measured:
            while spawned < case.robots:
                server.spawn()
                spawned += 1
            server.rounded(SETTLE)
            if case.driving:
                server.drive()
                server.rounded(SETTLE)
            server.pause()
            _take_turns(case, server)
            server.unpause()
    return measured


def _take_turns(case: Case, server: Server) -> None:
    with ExitStack() as stack:
        loops = {}
        for kind in LOOPS:
            driving = case.bare_drives if kind == 'bare' else case.driving
            loops[kind] = stack.enter_context(Loop(kind, case.robots, driving))
        for loop in loops.values():
            loop.speed(0.0)  # until it is ready
        for _ in range(ROUNDS):
            for kind, loop in loops.items():
                case.saw(kind, loop.speed(WINDOW))
            case.saw('server', _speed(server))
            if case.robots:
                speed, arrived = _speed_read(server, case.robots)
                case.saw('read', speed)
                case.arrived = max(case.arrived, arrived)


def _speed(server: Server) -> float:
    """Return the server's steps per second over a window; it is paused before and after."""
    server.unpause()
    begin, simulated = time.monotonic(), server.simulated()
    time.sleep(WINDOW)
    end, simulated = time.monotonic(), server.simulated() - simulated
    server.pause()
    return STEPS_PER_SECOND * simulated / (end - begin)


def _speed_read(server: Server, robots: int) -> tuple[float, float]:
    """Return the steps per second with a reader, and the share of the messages that reached it."""
    with Reader(*robot_topics(robots)) as reader:
        before, simulated = reader.messages(), server.simulated()
        speed = _speed(server)
        simulated = server.simulated() - simulated
        return speed, (reader.messages() - before) / (PER_SECOND * robots * simulated)


def table(measured: Sequence[Case]) -> str:
    """Return the measured cases as text."""
    rows = ['robots        bare  engine   world  server    read  Gazebo  server/bare  '
            'server/Gazebo        read/Gazebo  arrived']
    for case in measured:
        speeds = [*(case.best.get(column) for column in COLUMNS), case.gazebo]
        row = f'{case.name:10}'
        row += ''.join(f'{speed:8.0f}' if speed else 8 * ' ' for speed in speeds)
        row += f'{case.best["server"] / case.best["bare"]:13.3f}'
        row += f'{_against(case, "server", case.aim):>20}'
        row += f'{_against(case, "read", case.aim_read):>18}'
        row += f'{case.arrived:9.0%}' if case.robots else ''
        rows.append(row)
    first = _first_standing([case for case in measured if case.driving])
    rows.append('Gazebo: not measured here but estimated, by its quotient to the bare loop on '
                f'another machine; from {first} robots on that of standing ones')
    rows += [_real_time(case) for case in measured if case.robots in GAZEBO_BARE]
    return '\n'.join(rows)


def _real_time(case: Case) -> str:
    """Return how fast robots with readers run, here and on the machine Gazebo was measured on."""
    here = case.best['read'] / STEPS_PER_SECOND
    there = here * GAZEBO_BARE[case.robots] / case.best['bare']
    return (f'{case.name} with readers: {here:.2f} of real time here (aim 1), by the bare loop '
            f'{there:.2f} of it where Gazebo was measured')


def _against(case: Case, column: str, aim: float | None) -> str:
    """Return a quotient with Gazebo's speed, and whether it is what was aimed at."""
    if not case.gazebo or column not in case.best:
        return ''
    ratio = case.best[column] / case.gazebo
    return f'{ratio:.2f}' + (f' ({"met" if ratio >= aim else "NOT met"}: {aim:g})' if aim else '')


def draw(measured: Sequence[Case], path: Path) -> None:
    """Save the speeds of driving robots as a picture."""
    shown = [case for case in measured if case.driving]
    standing = f'from {_first_standing(shown)} robots on of standing ones'
    names = {
        'server': 'nobody subscribed',
        'read': 'odom, tf and joint_states subscribed',
        'bare': f'bare PyBullet, {standing}',
    }
    curves = {
        name: [(case.robots, case.best[column]) for case in shown] for column, name in names.items()
    }
    gazebo = ('Gazebo, nobody subscribed: estimated, its quotient to bare PyBullet\n'
              f'on another machine times bare PyBullet here, {standing}')
    curves[gazebo] = [(case.robots, case.gazebo) for case in shown if case.gazebo]
    plot_speed(path, curves, estimated=gazebo)


def _first_standing(driving: Sequence[Case]) -> int:
    """Return from how many robots on those of the bare loop stand, and Gazebo's quotient is so."""
    return min(case.robots for case in driving if not case.bare_drives)


def main() -> int:
    """Print the table, save the picture; return the exit code."""
    measured = in_a_process_of_its_own(measure)
    print(table(measured))
    draw(measured, PICTURE)
    print(f'picture: {PICTURE}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
