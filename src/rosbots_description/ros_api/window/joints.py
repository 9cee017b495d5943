"""Joints of robots, by the simulator's services; and commands to controllers of joints.

Publishes:
    the topics of `command` (std_msgs/Float64), each from its first command on.
"""

import rospy
from gazebo_msgs.msg import ODEJointProperties
from gazebo_msgs.srv import (
    ApplyJointEffort,
    GetJointProperties,
    JointRequest,
    SetJointProperties,
    SetModelConfiguration,
)
from std_msgs.msg import Float64

from .calls import call
from .topic_graph import TopicGraph

ENDLESS = rospy.Duration(-1)


class RosJoints:
    """Commands to joints; each raises SimError with a sentence if it is refused."""

    def __init__(self, topics: TopicGraph) -> None:
        self._topics = topics
        self._publishers: dict[str, rospy.Publisher] = {}

    def position(self, model: str, joint: str) -> float:
        """Return a position [rad or m]."""
        answer = call('get_joint_properties', GetJointProperties, joint_name=f'{model}::{joint}')
        return float(answer.position[0])

    def set_position(self, model: str, joint: str, position: float) -> None:
        """Move a joint there [rad or m] at once, whatever it meets."""
        call('set_model_configuration', SetModelConfiguration, model_name=model,
             joint_names=[joint], joint_positions=[position])

    def set_velocity(self, model: str, joint: str, velocity: float, effort: float) -> None:
        """Let a motor keep a velocity [rad/s or m/s] with an effort of at most so much [N m or N].

        No effort switches it off.
        """
        call('set_joint_properties', SetJointProperties, joint_name=f'{model}::{joint}',
             ode_joint_config=ODEJointProperties(vel=[velocity], fmax=[effort]))

    def set_effort(self, model: str, joint: str, effort: float) -> None:
        """Apply an effort [N m or N] from now on, in place of any on a joint of that name."""
        call('clear_joint_forces', JointRequest, joint_name=joint)
        if effort:
            call('apply_joint_effort', ApplyJointEffort, joint_name=f'{model}::{joint}',
                 effort=effort, duration=ENDLESS)

    def command_topics(self) -> list[str]:
        """Return the topics of numbers (std_msgs/Float64) that other nodes subscribe to."""
        return [name for name, kind in self._topics.subscribed().items() if kind == Float64._type]

    def command(self, topic: str, value: float) -> None:
        """Publish a number, latched, so that it arrives also if it is the first."""
        if topic not in self._publishers:
            self._publishers[topic] = rospy.Publisher(topic, Float64, latch=True, queue_size=1)
        self._publishers[topic].publish(value)
