"""Velocity commands to robots.

Publishes:
    the topic of `drive` (geometry_msgs/Twist), from its first command on.
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
        self._commands: rospy.Publisher | None = None

    def drive_topics(self) -> list[str]:
        """Return the topics of velocity commands that other nodes subscribe to; [] if unknown."""
        return [name for name, kind in self._topics.subscribed().items()
                if kind == Twist._type]

    def drive(self, topic: str, forward: float, left: float) -> None:
        """Publish a velocity command: forward [m/s], and turning left [rad/s]."""
        if self._commands is None or self._commands.name != topic:
            if self._commands is not None:
                self._commands.unregister()
            self._commands = rospy.Publisher(topic, Twist, queue_size=1)
            end = time.monotonic() + CONNECTION
            while not self._commands.get_num_connections() and time.monotonic() < end:
                time.sleep(0.01)
        command = Twist()
        command.linear.x, command.angular.z = forward, left
        self._commands.publish(command)
