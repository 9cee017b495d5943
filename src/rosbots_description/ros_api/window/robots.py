"""Velocity commands to robots.

Publishes:
    the topics of `drive` (geometry_msgs/Twist), each from its first command on.
"""

import threading
from collections import deque
from collections.abc import Callable

import rospy
from geometry_msgs.msg import Twist

from .topic_graph import TopicGraph

LATEST = 2  # commands that wait for a robot: one, and the stop after it


class RosRobots:
    """Robots that take velocity commands."""

    def __init__(self, topics: TopicGraph) -> None:
        self._topics = topics
        self._commands: dict[str, Commands] = {}

    def drive_topics(self) -> list[str]:
        """Return the topics of velocity commands that other nodes subscribe to; [] if unknown."""
        return [name for name, kind in self._topics.subscribed().items()
                if kind == Twist._type]

    def drive(self, topic: str, forward: float, left: float) -> None:
        """Publish a velocity command: forward [m/s], and turning left [rad/s]."""
        if topic not in self._commands:
            self._commands[topic] = Commands(topic)
        command = Twist()
        command.linear.x, command.angular.z = forward, left
        self._commands[topic].publish(command)


class Commands(rospy.SubscribeListener):  # type: ignore[misc]  # rospy has no types
    """The commands to one topic; the first wait until a robot has connected."""

    def __init__(self, topic: str) -> None:
        super().__init__()
        self._lock = threading.Lock()
        self._waiting: deque[Twist] = deque(maxlen=LATEST)
        self._publisher = rospy.Publisher(topic, Twist, self, queue_size=LATEST)

    def publish(self, command: Twist) -> None:
        """Publish a command, or keep it for the robot that connects first."""
        with self._lock:
            self._waiting.append(command)
            if self._publisher.get_num_connections():
                self._pass_on(self._publisher.publish)

    def peer_subscribe(self, _topic: str, _publish: Callable[[Twist], None],
                       peer_publish: Callable[[Twist], None]) -> None:
        """Publish what has waited; rospy calls it when a robot has connected."""
        with self._lock:
            self._pass_on(peer_publish)

    def _pass_on(self, publish: Callable[[Twist], None]) -> None:
        while self._waiting:
            publish(self._waiting.popleft())
