"""Joints of robots, by the simulator's services; and commands to controllers of joints.

Publishes:
    the topics of `command` (std_msgs/Float64, std_msgs/Float64MultiArray or
    trajectory_msgs/JointTrajectory), each from its first command on.
"""

from collections.abc import Callable, Mapping, Sequence

import rospy
from gazebo_msgs.msg import ODEJointProperties
from gazebo_msgs.srv import (
    ApplyJointEffort,
    GetJointProperties,
    JointRequest,
    SetJointProperties,
    SetModelConfiguration,
)
from std_msgs.msg import Float64, Float64MultiArray
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from ...sim.description import CommandTopic
from ..transport import NO_MASTER
from .calls import call
from .topic_graph import TopicGraph

ENDLESS = rospy.Duration(-1)
MOTION = rospy.Duration(1)  # in which a trajectory goes to where its sliders are
COMMAND = '/command'  # the end of the topics of controllers
POSITIONS = 'Position', 'Trajectory'  # in the types of controllers whose commands are positions


def trajectory(joints: Sequence[str], values: Sequence[float]) -> JointTrajectory:
    """Return a motion of joints to positions, that begins at once."""
    return JointTrajectory(
        joint_names=joints, points=[JointTrajectoryPoint(positions=values, time_from_start=MOTION)]
    )


# What controllers take of joints and values, by the type of their topics.
COMMANDS: Mapping[str, tuple[type, Callable[[Sequence[str], Sequence[float]], object]]] = {
    kind._type: (kind, message)
    for kind, message in (
        (Float64, lambda _joints, values: Float64(values[0])),
        (Float64MultiArray, lambda _joints, values: Float64MultiArray(data=values)),
        (JointTrajectory, trajectory),
    )
}


class RosJoints:
    """Commands to joints; each raises SimError with a sentence if it is refused."""

    def __init__(self, topics: TopicGraph) -> None:
        self._topics = topics
        self._publishers: dict[str, rospy.Publisher] = {}
        # Of the last look, by topic and message type; None is no controller's.
        self._offered: Mapping[tuple[str, str], CommandTopic | None] = {}

    def position(self, model: str, joint: str) -> float:
        """Return a position [rad or m]."""
        answer = call('get_joint_properties', GetJointProperties, joint_name=f'{model}::{joint}')
        return float(answer.position[0])

    def set_position(self, model: str, joint: str, position: float) -> None:
        """Move a joint there [rad or m] at once, whatever it meets."""
        call(
            'set_model_configuration',
            SetModelConfiguration,
            model_name=model,
            joint_names=[joint],
            joint_positions=[position],
        )

    def set_velocity(self, model: str, joint: str, velocity: float, effort: float) -> None:
        """Let a motor keep a velocity [rad/s or m/s] with an effort of at most so much [N m or N].

        No effort switches it off.
        """
        call(
            'set_joint_properties',
            SetJointProperties,
            joint_name=f'{model}::{joint}',
            ode_joint_config=ODEJointProperties(vel=[velocity], fmax=[effort]),
        )

    def set_effort(self, model: str, joint: str, effort: float) -> None:
        """Apply an effort [N m or N] from now on, in place of any on a joint of that name."""
        call('clear_joint_forces', JointRequest, joint_name=joint)
        if effort:
            call(
                'apply_joint_effort',
                ApplyJointEffort,
                joint_name=f'{model}::{joint}',
                effort=effort,
                duration=ENDLESS,
            )

    def command_topics(self) -> list[CommandTopic]:
        """Return the topics of commands that other nodes subscribe to.

        They are all of std_msgs/Float64, and those of controllers with a list of `joints`.
        """
        known = self._offered
        self._offered = {
            (name, kind): known[name, kind] if (name, kind) in known else _topic(name, kind)
            for name, kind in self._topics.subscribed().items()
            if kind in COMMANDS
        }
        return [topic for topic in self._offered.values() if topic]

    def command(self, topic: CommandTopic, values: Sequence[float]) -> None:
        """Publish values, latched, so that they arrive also if they are the first."""
        kind, message = COMMANDS[
            next((kind for (name, kind) in self._offered if name == topic.name), Float64._type)
        ]
        publisher = self._publishers.get(topic.name)
        if publisher is None or publisher.data_class is not kind:
            if publisher is not None:
                publisher.unregister()
            publisher = rospy.Publisher(topic.name, kind, latch=True, queue_size=1)
            self._publishers[topic.name] = publisher
        publisher.publish(message(topic.joints, values))


def _topic(name: str, kind: str) -> CommandTopic | None:
    """Return a topic of numbers, or of a controller with the parameter `joints`; else None."""
    if kind == Float64._type:
        return CommandTopic(name)
    try:
        parameters = rospy.get_param(name.removesuffix(COMMAND), None)
    except NO_MASTER:
        return None
    joints = parameters.get('joints') if isinstance(parameters, dict) else None
    if not name.endswith(COMMAND) or not isinstance(joints, list) or not joints:
        return None
    controller = str(parameters.get('type', ''))
    return CommandTopic(
        name, tuple(map(str, joints)), any(word in controller for word in POSITIONS)
    )
