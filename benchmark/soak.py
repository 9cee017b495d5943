#!/usr/bin/env python3
"""Let twenty robots drive for ten minutes while everything that clients can do is done to them.

Several processes spawn, delete, reset, pause, teleport, push and ask at random; others are killed
in mid-call. Printed: what was done, how the server's memory, files and threads grew, and every
answer, log line and clock message that nobody expected. The exit code is 1 if there is one.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import random
import re
import sys
import threading
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path

import rospy
from article import OUTPUT
from gazebo_msgs.srv import DeleteModel, GetWorldProperties
from geometry_msgs.msg import Twist
from rosgraph_msgs.msg import Clock
from server import Server, wait_until
from soak_client import VICTIM, Report, kill_clients, serve

ROBOTS, CLIENTS = 20, 3
GROWTH = 10.0  # [MB] that the server's memory may grow after the warm-up
WARM_UP = 0.1, 15.0  # share of the time, and least [s, wall]; by then all has been done once
SLACK = 3  # sockets and threads that may stay beside those at the start
SILENCE = 5.0  # [s, wall] /clock is never silent for so long; pauses are much shorter
PATIENCE = 30.0  # [s, wall] for clients to end, and for what they held to be freed
BACK_TO = 5.0  # [s, simulated] a reset is seen at the latest at this time
# What the log says about requests that are meant to fail, and about clients that die.
EXPECTED = re.compile(
    r'model name robot0 already exist|entity already exists|an <inertial> without <mass'
    r'|model \[(nobody|victim\w+)\] does not exist'
    r'|incoming connection failed: unable to receive data'
)
COMPLAINT = re.compile(r'\[ERROR\]|\[FATAL\]|Traceback|Error:|has died')


@dataclass
class Clocks:
    """Watches /clock: how often it jumped back, and what was no reset."""

    last: float = 0.0  # [s, simulated]
    jumps: int = 0
    messages: int = 0
    faults: list[str] = field(default_factory=list)

    def hear(self, message: Clock) -> None:
        """Take note of a time."""
        now = message.clock.to_sec()
        if now < self.last:
            self.jumps += 1
            if now > BACK_TO:
                self.faults.append(f'/clock went back from {self.last:g} s to {now:g} s')
        self.last = now
        self.messages += 1


@dataclass(frozen=True)
class Usage:
    """What a process holds."""

    memory: float  # [MB] resident
    files: int  # all that are open, connections too
    sockets: int
    threads: int

    def __str__(self) -> str:
        return (f'{self.memory:.1f} MB, {self.files} files, of them {self.sockets} sockets, '
                f'{self.threads} threads')


def usage(server: Server) -> Usage:
    """Return what the server holds now."""
    process = Path(f'/proc/{server.process}')
    files = []
    for file in (process / 'fd').iterdir():
        with contextlib.suppress(FileNotFoundError):  # closed meanwhile
            files.append(os.readlink(file))
    sockets = sum(file.startswith('socket:') for file in files)
    return Usage(server.memory(), len(files), sockets, len(list((process / 'task').iterdir())))


class Drivers:
    """Gives all robots new commands now and then, on a thread of its own."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)
        self._publishers = [rospy.Publisher(f'/robot{i}/cmd_vel', Twist, queue_size=1)
                            for i in range(ROBOTS)]
        self._over = threading.Event()
        threading.Thread(target=self._drive, daemon=True).start()

    def stop(self) -> None:
        """Give no more commands."""
        self._over.set()

    def _drive(self) -> None:
        command = Twist()
        while not self._over.wait(0.2):
            command.linear.x = self._random.uniform(-0.5, 0.5)
            command.angular.z = self._random.uniform(-1.0, 1.0)
            self._random.choice(self._publishers).publish(command)


class Crowd:
    """The processes of all clients."""

    def __init__(self, seed: int, robots: list[str]) -> None:
        """Start them; `robots` are the models that belong to all."""
        context = get_context('spawn')  # this process has a node of its own
        self._over = context.Event()
        self._pipes: list[Connection] = []
        self._processes = []
        for number, work in enumerate([*[serve] * CLIENTS, kill_clients]):
            ours, theirs = context.Pipe(duplex=False)
            process = context.Process(target=work, args=(
                number, seed + number, robots, self._over, theirs))
            process.start()
            theirs.close()
            self._pipes.append(ours)
            self._processes.append(process)
        for pipe in self._pipes:
            _received(pipe)  # each says when it begins

    def end(self) -> list[Report | None]:
        """Let them end; return what each did, None for one that broke down."""
        self._over.set()
        reports = [_received(pipe) for pipe in self._pipes]
        for process in self._processes:
            process.join(PATIENCE)
            process.kill()
        return reports


def _received(pipe: Connection) -> Report | None:
    try:
        return pipe.recv() if pipe.poll(PATIENCE) else None
    except EOFError:
        return None


@dataclass
class Soak:
    """What came of it."""

    reports: list[Report | None]
    clocks: Clocks
    start: Usage  # twenty robots, and nobody there yet
    warm: Usage  # a tenth of the time later, with all clients at work
    hot: Usage  # at the end, everybody still there
    end: Usage  # everybody gone
    faults: list[str]

    @property
    def done(self) -> Counter[str]:
        """Return how often each action was done."""
        return sum((report.done for report in self.reports if report), Counter())

    def all_faults(self) -> Iterator[str]:
        """Yield a sentence for everything that should not be."""
        yield from self.faults
        for number, report in enumerate(self.reports):
            yield from report.faults if report else [f'client {number} broke down']
        yield from self.clocks.faults
        resets = self.done['reset_simulation']
        if self.clocks.jumps > resets:
            yield f'/clock went back {self.clocks.jumps} times at {resets} resets'
        if self.hot.memory - self.warm.memory > GROWTH:
            yield f'memory grew by {self.hot.memory - self.warm.memory:.1f} MB'
        for kind in ('sockets', 'threads'):
            more = getattr(self.end, kind) - getattr(self.start, kind)
            if more > SLACK:
                yield f'{more} {kind} stayed open'

    def show(self) -> None:
        """Print what was measured."""
        for name, count in sorted(self.done.items()):
            print(f'{name:20} {count}')
        slowest = max((report.slowest for report in self.reports if report), default=0.0)
        print(f'slowest answer       {1000 * slowest:.0f} ms')
        clocks = self.clocks
        print(f'/clock               {clocks.messages} messages, {clocks.jumps} jumps back')
        for name in ('start', 'warm', 'hot', 'end'):
            print(f'server, {name:12} {getattr(self, name)}')


def soak(server: Server, seconds: float, seed: int) -> Soak:
    """Let everything happen to a server for so long [s, wall]."""
    robots = [f'robot{i}' for i in range(ROBOTS)]
    for _ in robots:
        server.spawn()
    clocks, faults = Clocks(), []
    rospy.Subscriber('/clock', Clock, clocks.hear, tcp_nodelay=True)
    wait_until(lambda: clocks.messages, 'a message on /clock')
    drivers = Drivers(seed)
    server.rounded(1.0)
    start, crowd = usage(server), Crowd(seed, robots)
    end = time.monotonic() + seconds
    time.sleep(max(WARM_UP[0] * seconds, WARM_UP[1]))
    warm = usage(server)
    while time.monotonic() < end:
        heard = clocks.messages
        time.sleep(SILENCE)
        if clocks.messages == heard:
            faults.append(f'/clock was silent for {SILENCE:g} s after {clocks.last:g} s')
    hot, reports = usage(server), crowd.end()
    drivers.stop()
    faults += left_over(server, robots)
    return Soak(reports, clocks, start, warm, hot, settled_usage(server, start), faults)


def left_over(server: Server, robots: list[str]) -> Iterator[str]:
    """Delete what killed clients left in the world; yield what is wrong about the rest."""
    names = server.service('get_world_properties', GetWorldProperties)().model_names
    delete = server.service('delete_model', DeleteModel)
    for name in names:
        if name.startswith(VICTIM) and not delete(name).success:
            yield f"'{name}' cannot be deleted"
    there = server.service('get_world_properties', GetWorldProperties)().model_names
    if there != ['ground_plane', *robots]:
        yield f'the models left are {", ".join(there)}'
    before = server.simulated()
    try:
        server.rounded(1.0)
    except TimeoutError:
        yield f'time stands at {before:g} s'


def settled_usage(server: Server, start: Usage) -> Usage:
    """Return what the server holds when the connections of those who left are closed."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        now = usage(server)
        if now.sockets <= start.sockets + SLACK and now.threads <= start.threads + SLACK:
            break
        time.sleep(0.5)
    return now


def complaints(log: Path) -> Iterator[str]:
    """Yield each line of the server's log that tells of a fault that no client asked for."""
    for line in log.read_text(encoding='utf-8', errors='replace').splitlines():
        if COMPLAINT.search(line) and not EXPECTED.search(line):
            yield f'in the log: {line[:300]}'


def main() -> int:
    """Start everything on a master of its own, soak, end it; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.partition('\n\n')[0])
    parser.add_argument('--seconds', type=float, default=600.0, help='how long [s, wall]')
    parser.add_argument('--seed', type=int, default=1, help='of all that is at random')
    arguments = parser.parse_args()
    with Server() as server:
        result = soak(server, arguments.seconds, arguments.seed)
    result.show()
    faults = Counter([*result.all_faults(), *complaints(OUTPUT / 'server.log')])
    for fault, count in faults.most_common():
        print(f'NOT EXPECTED ({count} x)  {fault}')
    print(f'{sum(faults.values())} faults in {arguments.seconds:g} s')
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
