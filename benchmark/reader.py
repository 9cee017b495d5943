#!/usr/bin/env python3
"""A node that subscribes to odom, joint_states and tf of robots and only counts the messages.

The process is told the number of robots. It writes a line when all topics are connected and then,
for each line on its standard input, how many messages have come.
"""

from __future__ import annotations

import subprocess
import sys
from itertools import count

import rospy
from server import wait_until

PER_SECOND = 500  # messages of one robot per simulated second: odom, joint_states and three edges


class Reader:
    """Such a node, in a process of its own, while a `with` statement lasts."""

    def __init__(self, robots: int) -> None:
        """Start it on this process's master and wait until it is connected."""
        self._process = subprocess.Popen(
            [sys.executable, __file__, str(robots)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        )
        self._process.stdout.readline()

    def __enter__(self) -> Reader:
        return self

    def __exit__(self, *_exception) -> None:
        self._process.communicate()

    def messages(self) -> int:
        """Return how many messages have come."""
        self._process.stdin.write('\n')
        self._process.stdin.flush()
        return int(self._process.stdout.readline())


def main() -> int:
    """Subscribe and count until the input ends; return the exit code."""
    rospy.init_node('reader', disable_rostime=True, disable_signals=True)
    counter = count()
    robots = range(int(sys.argv[1]))
    topics = [f'/robot{i}/{topic}' for i in robots for topic in ('odom', 'joint_states')]
    for name in ['/tf', *topics]:
        # as bytes: only the server's work is to be measured
        subscriber = rospy.Subscriber(name, rospy.AnyMsg, lambda _: next(counter))
        wait_until(subscriber.get_num_connections, f'a publisher of {name}')
    print('connected', flush=True)
    for _ in sys.stdin:
        print(next(counter), flush=True)
    rospy.signal_shutdown('read')
    return 0


if __name__ == '__main__':
    sys.exit(main())
