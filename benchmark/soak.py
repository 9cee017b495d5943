#!/usr/bin/env python3
"""Soak test: twenty robots drive for ten minutes while clients make random calls.

Several client processes spawn, delete, reset, pause, teleport, push and query at random; others are
killed in mid-call. Prints the calls, the growth of the server's memory, files and threads, and
every unexpected response, log line and clock message. The exit code is 1 if there is one.

Then a robot with a camera and a laser is spawned and deleted 300 times, while pages in the browser
connect, attack and disconnect. What server, renderer and page use afterwards is compared with what
they used after the first of these spawns.
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
from server import PATIENCE, Server, run_in_new_process, wait_until
from soak_client import VICTIM, Report, kill_clients, serve
from soak_spawns import LEAST, SLACK, soak_spawns

ROBOTS, CLIENTS = 20, 3
GROWTH = 10.0  # [MB] allowed growth of the server's memory after the warm-up
WARM_UP = 0.1  # share of the duration; all calls were made before
BACK_TO = 5.0  # [s, simulated] latest time at which a reset is noticed
# Log lines about requests that are meant to fail, and about killed clients.
EXPECTED = re.compile(
    r'model name robot0 already exist|entity already exists|an <inertial> without <mass'
    r'|model \[(nobody|victim\w+)\] does not exist'
    r'|incoming connection failed: unable to receive data'
)
SPAWN_TIME = 2.0  # [s, wall] of the first part for each spawn of the second: 300 in the whole test
COMPLAINT = re.compile(r'\[ERROR\]|\[FATAL\]|Traceback|Error:|has died')


@dataclass
class Clocks:
    """Watches /clock: counts jumps back, and lists those that no reset explains."""

    last: float = 0.0  # [s, simulated]
    jumps: int = 0
    messages: int = 0
    faults: list[str] = field(default_factory=list)

    def on_clock(self, message: Clock) -> None:
        """Record a time."""
        now = message.clock.to_sec()
        if now < self.last:
            self.jumps += 1
            if now > BACK_TO:
                self.faults.append(f'/clock went back from {self.last:g} s to {now:g} s')
        self.last = now
        self.messages += 1

    def await_message(self) -> None:
        """Wait for another one.

        Raises:
            TimeoutError: there was none within `PATIENCE`.
        """
        before = self.messages
        wait_until(lambda: self.messages != before, 'a message on /clock')


@dataclass(frozen=True)
class Usage:
    """Resources of a process."""

    memory: float  # [MB] resident
    files: int  # open file descriptors, sockets included
    sockets: int
    threads: int

    def __str__(self) -> str:
        return (
            f'{self.memory:.1f} MB, {self.files} files including {self.sockets} sockets, '
            f'{self.threads} threads'
        )


def usage(server: Server) -> Usage:
    """Return the resources that the server uses now."""
    process = Path(f'/proc/{server.process}')
    files = []
    for file in (process / 'fd').iterdir():
        with contextlib.suppress(FileNotFoundError):  # closed meanwhile
            files.append(os.readlink(file))
    sockets = sum(file.startswith('socket:') for file in files)
    return Usage(server.memory(), len(files), sockets, len(list((process / 'task').iterdir())))


class Drivers:
    """Sends random robots new velocity commands, on its own thread."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)
        self._publishers = [
            rospy.Publisher(f'/robot{i}/cmd_vel', Twist, queue_size=1) for i in range(ROBOTS)
        ]
        self._over = threading.Event()
        threading.Thread(target=self._drive, daemon=True).start()

    def stop(self) -> None:
        """Send no more commands."""
        self._over.set()

    def _drive(self) -> None:
        command = Twist()
        while not self._over.wait(0.2):
            command.linear.x = self._random.uniform(-0.5, 0.5)
            command.angular.z = self._random.uniform(-1.0, 1.0)
            self._random.choice(self._publishers).publish(command)


class Clients:
    """All client processes."""

    def __init__(self, seed: int, robots: list[str]) -> None:
        """Start them; `robots` are the models that they share."""
        context = get_context('spawn')  # this process is a node already
        self._over = context.Event()
        self._pipes: list[Connection] = []
        self._processes = []
        for number, work in enumerate([*[serve] * CLIENTS, kill_clients]):
            ours, theirs = context.Pipe(duplex=False)
            process = context.Process(
                target=work, args=(number, seed + number, robots, self._over, theirs)
            )
            process.start()
            theirs.close()
            self._pipes.append(ours)
            self._processes.append(process)
        for pipe in self._pipes:
            _received(pipe)  # each reports when it is ready; one that crashed is noticed at the end

    def end(self) -> list[Report | None]:
        """End them; return the report of each, None for one that crashed."""
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
    """Results of the soak test."""

    reports: list[Report | None]
    clocks: Clocks
    start: Usage  # twenty robots, no clients
    warm: Usage  # after the warm-up, with all clients
    hot: Usage  # at the end, with all clients
    end: Usage  # after all clients have left
    faults: list[str]

    @property
    def done(self) -> Counter[str]:
        """Return the count of each action."""
        return sum((report.done for report in self.reports if report), Counter())

    def all_faults(self) -> Iterator[str]:
        """Yield a sentence for each fault."""
        yield from self.faults
        for number, report in enumerate(self.reports):
            yield from report.faults if report else [f'client {number} crashed']
        yield from self.clocks.faults
        resets = self.done['reset_simulation']
        if self.clocks.jumps > resets:
            yield f'/clock went back {self.clocks.jumps} times in {resets} resets'
        if self.hot.memory - self.warm.memory > GROWTH:
            yield f'memory grew by {self.hot.memory - self.warm.memory:.1f} MB'
        for kind in ('sockets', 'threads'):
            more = getattr(self.end, kind) - getattr(self.start, kind)
            if more > SLACK:
                yield f'{more} {kind} were not freed'

    def show(self) -> None:
        """Print the results."""
        for name, count in sorted(self.done.items()):
            print(f'{name:20} {count}')
        slowest = max((report.slowest for report in self.reports if report), default=0.0)
        print(f'slowest response     {1000 * slowest:.0f} ms')
        clocks = self.clocks
        print(f'/clock               {clocks.messages} messages, {clocks.jumps} jumps back')
        for name in ('start', 'warm', 'hot', 'end'):
            print(f'server, {name:12} {getattr(self, name)}')


def soak(server: Server, seconds: float, seed: int) -> Soak:
    """Run the soak test on a server for `seconds` [wall] after its clients are ready."""
    robots = [f'robot{i}' for i in range(ROBOTS)]
    for _ in robots:
        server.spawn()
    clocks, faults = Clocks(), []
    rospy.Subscriber('/clock', Clock, clocks.on_clock, tcp_nodelay=True)
    wait_until(lambda: clocks.messages, 'a message on /clock')
    drivers = Drivers(seed)
    server.wait_simulated(1.0)
    start, clients = usage(server), Clients(seed, robots)
    end = time.monotonic() + seconds
    time.sleep(WARM_UP * seconds)
    warm = usage(server)
    while time.monotonic() < end:
        try:
            clocks.await_message()
        except TimeoutError as error:
            faults.append(f'{error}, after {clocks.last:g} s')
        time.sleep(0.1)
    hot, reports = usage(server), clients.end()
    drivers.stop()
    faults += leftover_faults(server, robots)
    return Soak(reports, clocks, start, warm, hot, settled_usage(server, start), faults)


def leftover_faults(server: Server, robots: list[str]) -> Iterator[str]:
    """Delete models of killed clients; yield a sentence for each fault of what remains."""
    names = server.service('get_world_properties', GetWorldProperties)().model_names
    delete = server.service('delete_model', DeleteModel)
    for name in names:
        if name.startswith(VICTIM) and not delete(name).success:
            yield f"'{name}' cannot be deleted"
    names = server.service('get_world_properties', GetWorldProperties)().model_names
    if names != ['ground_plane', *robots]:
        yield f'the remaining models are {", ".join(names)}'
    before = server.simulated()
    try:
        server.wait_simulated(1.0)
    except TimeoutError:
        yield f'simulated time stands still at {before:g} s'


def settled_usage(server: Server, start: Usage) -> Usage:
    """Return the resources of the server after the connections of the clients are closed."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        now = usage(server)
        if now.sockets <= start.sockets + SLACK and now.threads <= start.threads + SLACK:
            break
        time.sleep(0.5)
    return now


def complaints(log: Path) -> Iterator[str]:
    """Yield each line of the server's log about an unexpected fault."""
    for line in log.read_text(encoding='utf-8', errors='replace').splitlines():
        if COMPLAINT.search(line) and not EXPECTED.search(line):
            yield f'in the log: {line[:300]}'


def main() -> int:
    """Run the soak test with its own ROS master; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.partition('\n\n')[0])
    parser.add_argument(
        '--seconds',
        type=float,
        default=600.0,
        help='duration of the first part [s, wall]; the second one has half as many spawns',
    )
    parser.add_argument('--seed', type=int, default=1, help='of all random choices')
    arguments = parser.parse_args()
    with Server() as server:
        result = soak(server, arguments.seconds, arguments.seed)
    result.show()
    faults = Counter([*result.all_faults(), *complaints(OUTPUT / 'server.log')])
    spawns = max(LEAST, round(arguments.seconds / SPAWN_TIME))
    faults.update(run_in_new_process(soak_spawns, spawns, arguments.seed))
    faults.update(complaints(OUTPUT / 'server.log'))
    for fault, count in faults.most_common():
        print(f'UNEXPECTED ({count} x)  {fault}')
    print(f'{sum(faults.values())} faults in {arguments.seconds:g} s and {spawns} spawns')
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
