#!/usr/bin/env python3
"""A node that subscribes to topics and only counts the messages.

The process is told the topics. It writes a line when all topics are connected and then,
for each line on its standard input, how many messages have come.
"""

from __future__ import annotations

import sys
from itertools import count

import rospy
from child import Child
from server import wait_until

PER_SECOND = 500  # messages of one robot per simulated second: odom, joint_states and three edges


def robot_topics(robots: int) -> list[str]:
    """Return what robots tell of their motion."""
    return ['/tf', *(f'/robot{i}/{topic}' for i in range(robots)
                     for topic in ('odom', 'joint_states'))]


class Reader(Child):
    """Such a node, in a process of its own, while a `with` statement lasts."""

    def __init__(self, *topics: str) -> None:
        """Start it on this process's master and wait until it is connected."""
        super().__init__(__file__, *topics)
        self.answer()

    def messages(self) -> int:
        """Return how many messages have come."""
        return int(self.ask())


def main() -> int:
    """Subscribe and count until the input ends; return the exit code."""
    rospy.init_node('reader', disable_rostime=True, disable_signals=True)
    counter = count()
    for name in sys.argv[1:]:
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
