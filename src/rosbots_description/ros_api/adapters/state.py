"""The topics of plugins that publish or set states.

Subscribes:
    <ns>/<topicName> (trajectory_msgs/JointTrajectory): what joint_pose_trajectory plays.
Publishes:
    <ns>/<topicName> (nav_msgs/Odometry): p3d; the child frame is that of the link, without prefix.
    <ns>/joint_states (sensor_msgs/JointState): joint_state_publisher.
Parameters:
    tf_prefix, searched from the plugin's namespace upward: p3d.
"""

import math
from typing import Any

from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from ...sim.plugins import P3D, JointPoseTrajectory, JointStatePublisher
from ..messages import OdometryLayout
from .adapter import Adapter
from .declarations import Publishes, Serializer, Subscribes
from .registry import declare_topics
from .serializers import JointStatesSerializer


def true_odometry_serializer(adapter: Adapter) -> Serializer:
    """Return what lays the odometry of p3d out."""
    plugin = adapter.plugin
    assert isinstance(plugin, P3D)
    variances = (plugin.noise**2,) * 6
    frame = adapter.frame(plugin.params.string('frameName'))
    return OdometryLayout(frame, plugin.body, variances, variances).pack


def read_trajectory(message: JointTrajectory) -> tuple[Any, ...]:
    """Return what `JointPoseTrajectory.play` takes.

    Raises:
        ValueError: a position is not finite.
    """
    points = []
    for index, point in enumerate(message.points):
        bad = [position for position in point.positions if not math.isfinite(position)]
        if bad:
            raise ValueError(f'positions of point {index} {bad[0]}; numbers must be finite')
        points.append((point.positions, point.time_from_start.to_nsec()))
    header = message.header
    return header.frame_id, header.stamp.to_nsec(), message.joint_names, points


declare_topics(
    P3D, Publishes('odometry', Odometry, serializer=true_odometry_serializer, always=True)
)
declare_topics(
    JointStatePublisher,
    Publishes('joint_states', JointState, serializer=JointStatesSerializer, queue=1000),
)
declare_topics(
    JointPoseTrajectory,
    Subscribes('play', JointTrajectory, read_trajectory, '<topicName>', queue=100),
)
