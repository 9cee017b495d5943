"""What the topics of all drives share.

Subscribes:
    <ns>/<commandTopic> (geometry_msgs/Twist): what the drive follows; the last counts.
Publishes:
    <ns>/<odometryTopic> (nav_msgs/Odometry), if the plugin sends odometry.
    /tf (tf2_msgs/TFMessage): odometry frame to base frame, if the plugin sends it. Beside a
        robot_state_publisher: odometry frame to the root of what that holds together.
Parameters:
    tf_prefix, searched from the plugin's namespace upward.
"""

import logging
import math
import time
from functools import partial

import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry as OdometryMessage
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

from ...sim.plugins.drive import Drive
from ...sim.pose import Pose
from ...sim.readings import FrameTransform, JointStates, Odometry
from ..layouts import JointStatesLayout, OdometryLayout, TransformLayout
from ..log_bridge import set_level
from ..master import subscribers
from ..names import find_tf_prefix, frame_name, topic_name
from ..sending import has_readers, next_number, publish_serialized, reader_names
from ..server import Server
from ..static_frames import TOPIC as STATIC_FRAMES
from ..static_frames import from_root
from .registry import Adapter

logger = logging.getLogger(__name__)

COMPLAINT_PERIOD = 5.0  # least time between two complaints about bad commands [s, wall]


class DriveAdapter(Adapter):
    """Joins a `Drive` to its topics."""

    def __init__(self, server: Server, plugin: Drive) -> None:
        super().__init__(server, plugin)
        self._prefix = ''
        # How the messages are laid out: once their frames are known they stay.
        self._odometry_layout: OdometryLayout | None = None
        self._edges: dict[tuple[str, str], TransformLayout] = {}  # by parent and child
        self._odometry = self._tf = None
        self._complained = -math.inf
        self._told_root = ''  # said once, not with every message
        self._command_topic = topic_name(plugin.namespace, plugin.config.command_topic)
        self._odometry_topic = topic_name(plugin.namespace, plugin.config.odometry_topic)

    def open(self) -> None:
        """Advertise and subscribe, with upstream's log lines, if verbose."""
        plugin, config, prefix = self.plugin, self.plugin.config, self.plugin.log_prefix
        self._prefix = find_tf_prefix(plugin.namespace)
        logger.debug('%s<tf_prefix> = %s', prefix, self._prefix)
        self.open_states()
        self._tf = self.advertise('/tf', TFMessage, 100)
        logger.debug('%sTry to subscribe to %s', prefix, config.command_topic)
        self.subscribe(self._command_topic, Twist, self._on_command, 1)
        logger.debug('%sSubscribe to %s', prefix, config.command_topic)
        if plugin.sends_odometry:
            self._odometry_layout = OdometryLayout(
                frame_name(self._prefix, config.odometry_frame),
                frame_name(self._prefix, config.robot_base_frame),
                plugin.pose_variances,
                plugin.twist_variances,
            )
            self._odometry = self.advertise(self._odometry_topic, OdometryMessage, 1)
            logger.debug('%sAdvertise odom on %s ', prefix, config.odometry_topic)

    def open_states(self) -> None:
        """Advertise what this drive has beside odometry."""

    def connect(self) -> None:
        """Join the plugin's odometry to the publishers that were opened."""
        if self._odometry is not None:
            both = (self._odometry, self._tf)
            shown = both if self.plugin.sends_transform else both[:1]
            self.plugin.odometry.connect(self._send_odometry, partial(has_readers, *shown))

    def disconnect(self) -> None:
        """Let the plugin's odometry go nowhere."""
        self.plugin.odometry.disconnect()

    def _send_odometry(self, reading: Odometry) -> None:
        config = self.plugin.config
        if self.plugin.sends_transform and has_readers(self._tf):
            edge = self._on_the_wire(
                FrameTransform(config.odometry_frame, config.robot_base_frame, reading.pose))
            moved = from_root(edge, self.server.static_frames.parents)
            if moved.child != edge.child:
                self._tell_root(edge, moved)
            self._publish_transform(moved)
        if has_readers(self._odometry):
            if self.plugin.flat_odometry:
                (x, y, _), orientation = reading.pose
                reading = Odometry(Pose((x, y, 0.0), orientation), reading.twist)
            number = next_number(self._odometry)
            message = self._odometry_layout.pack(number, self._now_ns(), reading)
            publish_serialized(self._odometry, message)

    def _tell_root(self, edge: FrameTransform, moved: FrameTransform) -> None:
        if self._told_root != moved.child:
            self._told_root = moved.child
            logger.debug(
                '%sanother node holds %s still in %s, so %s -> %s is published in place of %s -> '
                '%s: TF keeps one parent for each frame', self.plugin.log_prefix, edge.child,
                moved.child, moved.parent, moved.child, edge.parent, edge.child,
            )

    def _on_the_wire(self, edge: FrameTransform) -> FrameTransform:
        """Return the edge with its frames named as messages name them."""
        parent, child, pose = edge
        return FrameTransform(
            frame_name(self._prefix, parent), frame_name(self._prefix, child), pose)

    def _publish_transform(self, edge: FrameTransform) -> None:
        parent, child, pose = edge
        layout = self._edges.get((parent, child))
        if layout is None:
            layout = self._edges[parent, child] = TransformLayout(parent, child)
        publish_serialized(self._tf, layout.pack(self._now_ns(), pose))

    def _now_ns(self) -> int:
        return self.server.world.clock.now_ns

    def _on_command(self, message: Twist) -> None:
        """Hand a command over; one that is not finite is dropped and the last good one stays."""
        linear, plugin = message.linear, self.plugin
        numbers = {'linear.x': linear.x, 'angular.z': message.angular.z}
        if plugin.moves_sideways:
            numbers['linear.y'] = linear.y
        bad = [f'{name} {value}' for name, value in numbers.items() if not math.isfinite(value)]
        if not bad:
            self.server.loop.post(lambda: plugin.command(*numbers.values()))
        elif time.monotonic() > self._complained + COMPLAINT_PERIOD:
            self._complained = time.monotonic()
            logger.error(
                '%sdropped a command on %s with %s; it takes finite numbers',
                plugin.log_prefix, plugin.config.command_topic, ' and '.join(bad),
            )


class WheeledDriveAdapter(DriveAdapter):
    """Joins a drive to its topics that tells of its wheels, too.

    Publishes beside the others: /tf (the wheels, if publishWheelTF) and <ns>/joint_states
    (sensor_msgs/JointState, if publishWheelJointState).
    """

    def __init__(self, server: Server, plugin: Drive) -> None:
        super().__init__(server, plugin)
        self._joint_states = None
        self._joints: dict[tuple[str, ...], JointStatesLayout] = {}  # by names
        self._followers: set[str] = set()  # who reads the joint states, once it can
        # Also where it is not published: as in Gazebo the namespace alone must be good.
        self._joint_states_topic = topic_name(plugin.namespace, 'joint_states')

    def open(self) -> None:
        """Advertise and subscribe, with upstream's log lines."""
        set_level(self.plugin.config.ros_debug_level)
        logger.debug('Starting plugin %s', self.plugin.log_prefix.removesuffix(': '))
        super().open()

    def open_states(self) -> None:
        """Advertise joint_states, if they are wanted."""
        if self.plugin.config.publish_wheel_joint_state:
            states, server = rospy.resolve_name(self._joint_states_topic), self.server
            self._followers, holding = subscribers(states, STATIC_FRAMES)
            # What they hold may be on its way, and the first wheels would be told twice.
            expected = (holding & self._followers) - {rospy.get_name()}
            server.loop.post(lambda: server.static_frames.expect(expected))
            self._joint_states = self.advertise(self._joint_states_topic, JointState, 1000)
            logger.debug('%sAdvertise joint_states', self.plugin.log_prefix)

    def connect(self) -> None:
        """Join the plugin's outputs to the publishers that were opened."""
        super().connect()
        plugin = self.plugin
        if self._tf is not None:
            plugin.wheel_transform.connect(self._send_wheel, self._wheels_wanted)
        if self._joint_states is not None:
            plugin.joint_states.connect(
                self._send_joint_states, partial(has_readers, self._joint_states)
            )

    def disconnect(self) -> None:
        """Let the plugin's outputs go nowhere."""
        super().disconnect()
        self.plugin.wheel_transform.disconnect()
        self.plugin.joint_states.disconnect()

    def _send_wheel(self, reading: FrameTransform) -> None:
        self._publish_transform(self._on_the_wire(reading))

    def _wheels_wanted(self) -> bool:
        """Tell whether to publish the wheels' frames: not beside a robot_state_publisher.

        That is a node which reads our joint states and holds frames still.
        """
        return has_readers(self._tf) and not (
            self._joint_states is not None
            and self.server.static_frames.nodes.intersection(
                self._followers | reader_names(self._joint_states))
        )

    def _send_joint_states(self, reading: JointStates) -> None:
        layout = self._joints.get(reading.names)
        if layout is None:
            layout = self._joints[reading.names] = JointStatesLayout(reading)
        number = next_number(self._joint_states)
        publish_serialized(self._joint_states, layout.pack(number, self._now_ns(), reading))
