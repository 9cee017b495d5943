"""The topics of drives.

Subscribes:
    <ns>/<commandTopic> (geometry_msgs/Twist): velocity command; it holds until the next one.
Publishes:
    <ns>/<odometryTopic> (nav_msgs/Odometry), if the plugin sends odometry.
    /tf (tf2_msgs/TFMessage): odometry frame to base frame, if the plugin sends it. Beside a
        robot_state_publisher: odometry frame to the root of its static tree.
        diff_drive and tricycle_drive: the wheels too, if publishWheelTF.
    <ns>/joint_states (sensor_msgs/JointState): diff_drive (right, left) and tricycle_drive (with
        velocities and efforts), if publishWheelJointState.
Parameters:
    tf_prefix, searched from the plugin's namespace upward.
"""

import logging

import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry as OdometryMessage
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

from ...sim.plugins import DiffDrive, ForceBasedMove, PlanarMove, SkidSteerDrive, TricycleDrive
from ..server import STATIC_TOPIC
from ..transport import set_level, subscriber_names, subscribers
from .declarations import Endpoint, PublishedTopic, Publishes, Subscribes, finite
from .registry import declare_topics
from .serializers import (
    JointStatesSerializer,
    RootedTransformSerializer,
    TransformSerializer,
    odometry_serializer,
)

logger = logging.getLogger(__name__)


class StartLog(Endpoint):
    """What upstream does before it has any topic: it logs, and at another level if asked to."""

    def open(self) -> None:
        """Log what upstream logs."""
        plugin = self.adapter.plugin
        if 'rosDebugLevel' in plugin.params.values:
            set_level(self.adapter.text('<rosDebugLevel>'))
            logger.debug('Starting plugin %s', plugin.log_prefix.removesuffix(': '))
        logger.debug('%s<tf_prefix> = %s', plugin.log_prefix, self.adapter.tf_prefix)


class WheelStatesTopic(PublishedTopic):
    """The joint states of wheels, from which a robot_state_publisher may make their frames.

    The topic knows who reads it, and who soon will.
    """

    _followers: frozenset[str] = frozenset()  # those that read it as soon as they can

    def open(self) -> None:
        """Advertise it."""
        if self.has_output:
            server = self.adapter.server
            followers, holding = subscribers(rospy.resolve_name(self.name), STATIC_TOPIC)
            self._followers = frozenset(followers)
            # What they hold may be on its way, and the first wheels would be told twice.
            expected = (holding & followers) - {rospy.get_name()}
            server.loop.post(lambda: server.static_frames.expect(expected))
        super().open()

    def readers(self) -> frozenset[str]:
        """Return the names of the nodes that read it, or soon will."""
        return self._followers | subscriber_names(self.publisher) if self.publisher else frozenset()


class WheelFramesTopic(PublishedTopic):
    """The frames of wheels, which are left to a robot_state_publisher if there is one.

    That is a node that subscribes to our joint states and publishes static transforms.
    """

    def is_wanted(self) -> bool:
        """Tell whether to publish the frames."""
        nodes = self.adapter.server.static_frames.nodes
        return super().is_wanted() and not (
            nodes
            and any(
                nodes.intersection(states.readers())
                for states in self.adapter.endpoints
                if isinstance(states, WheelStatesTopic)
            )
        )

    def send(self, reading: object) -> None:
        """Publish a frame, unless such a node has subscribed since the readers were counted."""
        if self.is_wanted():
            super().send(reading)


COMMAND, SIDEWAYS = (
    Subscribes(
        'command',
        Twist,
        finite(*fields),
        log_before='Try to subscribe to {}',
        log='Subscribe to {}',
    )
    for fields in (('linear.x', 'angular.z'), ('linear.x', 'angular.z', 'linear.y'))
)
ODOMETRY = Publishes(
    'odometry', OdometryMessage, serializer=odometry_serializer, log='Advertise odom on {} '
)
TRANSFORM = Publishes(
    'odometry_transform',
    TFMessage,
    '/tf',
    serializer=RootedTransformSerializer,
    queue=100,
    always=True,
)
WHEELS = (
    Publishes(
        'joint_states',
        JointState,
        serializer=JointStatesSerializer,
        queue=1000,
        log='Advertise joint_states',
        endpoint=WheelStatesTopic,
    ),
    Publishes(
        'wheel_transform',
        TFMessage,
        '/tf',
        serializer=TransformSerializer,
        queue=100,
        endpoint=WheelFramesTopic,
    ),
)

for wheeled in (DiffDrive, TricycleDrive):
    declare_topics(wheeled, StartLog, *WHEELS, TRANSFORM, COMMAND, ODOMETRY)
declare_topics(SkidSteerDrive, StartLog, TRANSFORM, COMMAND, ODOMETRY)
for moved in (PlanarMove, ForceBasedMove):
    declare_topics(moved, StartLog, TRANSFORM, SIDEWAYS, ODOMETRY)
