"""Velocity commands to robots.

Publishes:
    the topics of `drive` (geometry_msgs/Twist), each from its first command on.
"""

import time

import rospy
from geometry_msgs.msg import Twist

from .topic_graph import TopicGraph

CONNECTION = 0.5  # [s, wall] that the first command waits for its robot


class RosRobots:
    """Robots that take velocity commands."""

    def __init__(self, topics: TopicGraph) -> None:
        self._topics = topics
        self._publishers: dict[str, rospy.Publisher] = {}

    def drive_topics(self) -> list[str]:
        """Return the topics of velocity commands that other nodes subscribe to; [] if unknown."""
        return [name for name, kind in self._topics.subscribed().items()
                if kind == Twist._type]

    def drive(self, topic: str, forward: float, left: float) -> None:
        """Publish a velocity command: forward [m/s], and turning left [rad/s]."""
        if topic not in self._publishers:
            made = self._publishers[topic] = rospy.Publisher(topic, Twist, queue_size=1)
            end = time.monotonic() + CONNECTION
            while not made.get_num_connections() and time.monotonic() < end:
                time.sleep(0.01)
        command = Twist()
        command.linear.x, command.angular.z = forward, left
        self._publishers[topic].publish(command)
