"""Velocity commands to robots.

Publishes:
    the topics of `drive` (geometry_msgs/Twist), each from its first command on.
"""

from geometry_msgs.msg import Twist

from .commands import Commands
from .topic_graph import TopicGraph


class RosRobots:
    """Robots that take velocity commands."""

    def __init__(self, topics: TopicGraph) -> None:
        self._topics = topics
        self._commands: dict[str, Commands] = {}

    def drive_topics(self) -> list[str]:
        """Return the topics of velocity commands that other nodes subscribe to; [] if unknown."""
        return [name for name, kind in self._topics.subscribed().items() if kind == Twist._type]

    def drive(self, topic: str, forward: float, left: float) -> None:
        """Publish a velocity command: forward [m/s], and turning left [rad/s]."""
        if topic not in self._commands:
            self._commands[topic] = Commands(topic, Twist)
        command = Twist()
        command.linear.x, command.angular.z = forward, left
        self._commands[topic].publish(command)
