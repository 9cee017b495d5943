"""Goals and initial poses for the programs of navigation.

Publishes:
    topics of geometry_msgs/PoseStamped and geometry_msgs/PoseWithCovarianceStamped to which others
    subscribe, such as /move_base_simple/goal and /initialpose, each from its first pose on.
"""

import math
from collections.abc import Collection
from typing import Any

import genpy
import rospy
from geometry_msgs.msg import Pose as PoseMessage
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped

from ...sim.core import Pose
from ..messages import fill_pose
from .commands import Commands
from .frames import FrameFinder
from .topic_graph import TopicGraph

# As RViz sends it: standard deviations of 0.5 m and 15 degrees.
SPREAD, TURN = 0.5**2, math.radians(15.0) ** 2  # [m^2], [rad^2]
X, Y, YAW = 0, 7, 35  # in the covariance, of (x, y, z, roll, pitch, yaw)


class RosGoals:
    """Topics that take poses."""

    def __init__(self, graph: TopicGraph) -> None:
        self._graph = graph
        self._frames = FrameFinder()
        self._commands: dict[str, Commands] = {}

    def goal_topics(self) -> list[str]:
        """Return the topics of goals that other nodes subscribe to, those called goal first."""
        return self._subscribed(PoseStamped, 'goal')

    def estimate_topics(self) -> list[str]:
        """Return the topics of initial poses that other nodes subscribe to."""
        return self._subscribed(PoseWithCovarianceStamped, 'initialpose')

    def locate(self, frame: str, links: Collection[str]) -> tuple[str, Pose] | None:
        """Return a link of these that TF connects a frame with, and the frame's pose in it.

        The first call begins to listen to TF.
        """
        return self._frames.locate(frame, links)

    def rest(self) -> None:
        """Listen no more."""
        self._frames.forget()

    def send_goal(self, topic: str, frame: str, pose: Pose) -> None:
        """Publish a goal, as of now."""
        goal = PoseStamped()
        self._send(topic, goal, frame, goal.pose, pose)

    def send_estimate(self, topic: str, frame: str, pose: Pose) -> None:
        """Publish an initial pose, as of now, with RViz's uncertainty."""
        estimate = PoseWithCovarianceStamped()
        covariance = [0.0] * 36
        covariance[X] = covariance[Y] = SPREAD
        covariance[YAW] = TURN
        estimate.pose.covariance = covariance
        self._send(topic, estimate, frame, estimate.pose.pose, pose)

    def _subscribed(self, kind: type[Any], name: str) -> list[str]:
        """Return topics of a type, those that end with a name first."""
        topics = [topic for topic, other in self._graph.subscribed().items() if other == kind._type]
        return sorted(topics, key=lambda topic: not topic.endswith(name))

    def _send(
        self, topic: str, message: genpy.Message, frame: str, field: PoseMessage, pose: Pose
    ) -> None:
        message.header.frame_id, message.header.stamp = frame, rospy.Time.now()
        fill_pose(field, pose)
        if topic not in self._commands:
            self._commands[topic] = Commands(topic, type(message))
        self._commands[topic].publish(message)
