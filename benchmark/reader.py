#!/usr/bin/env python3
"""A node that subscribes to topics and counts the messages.

Arguments: the topics. The process writes a line when all topics are connected and then, for each
line on standard input, the number of messages received so far.
"""

from __future__ import annotations

import sys
from itertools import count

import rospy
from child import Child
from server import wait_until

PER_SECOND = 500  # messages per robot and simulated second: odom, joint_states, three transforms


def robot_topics(robots: int) -> list[str]:
    """Return the topics on which robots publish their motion."""
    return [
        '/tf',
        *(f'/robot{i}/{topic}' for i in range(robots) for topic in ('odom', 'joint_states')),
    ]


class Reader(Child):
    """Runs the node in a child process, for the length of a `with` statement."""

    def __init__(self, *topics: str) -> None:
        """Start the node with this process's ROS master and wait until it is connected."""
        super().__init__(__file__, *topics)
        self.answer()

    def messages(self) -> int:
        """Return the number of messages received so far."""
        return int(self.ask())


def main() -> int:
    """Subscribe and count until the input ends; return the exit code."""
    rospy.init_node('reader', disable_rostime=True, disable_signals=True)
    counter = count()
    for name in sys.argv[1:]:
        # AnyMsg is not deserialized: only the work of the server is measured
        subscriber = rospy.Subscriber(name, rospy.AnyMsg, lambda _: next(counter))
        wait_until(subscriber.get_num_connections, f'a publisher of {name}')
    print('connected', flush=True)
    for _ in sys.stdin:
        print(next(counter), flush=True)
    rospy.signal_shutdown('read')
    return 0


if __name__ == '__main__':
    sys.exit(main())
