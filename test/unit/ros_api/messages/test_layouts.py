"""Messages serialized by hand have the same bytes as with rospy."""

import io
import math
from types import SimpleNamespace

import numpy as np
import pytest
from genpy import Time
from geometry_msgs.msg import Point32, TransformStamped
from nav_msgs.msg import Odometry as OdometryMessage
from rospy.msg import serialize_message
from sensor_msgs.msg import ChannelFloat32, Imu, JointState, LaserScan, PointCloud
from tf2_msgs.msg import TFMessage

from rosbots_description.ros_api.messages.conversions import fill_pose, fill_transform, fill_twist
from rosbots_description.ros_api.messages.layouts import (
    ImuLayout,
    JointStatesLayout,
    LaserScanLayout,
    OdometryLayout,
    PointCloudLayout,
    TransformLayout,
)
from rosbots_description.ros_api.transport.sending import next_number
from rosbots_description.sim.core.transforms import Pose, Twist
from rosbots_description.sim.runtime.outputs import JointStates, Odometry
from rosbots_description.sim.sensors import ImuReading

SEQ, NOW_NS = 258, 12_000_000_345
STAMP = Time(12, 345)
POSE = Pose((1.0, -2.0, 3.0), (0.1, 0.2, 0.3, math.nan))
TWIST = Twist((0.1, 0.2, 0.3), (0.4, 0.5, math.inf))
FRAMES = [('odom', 'base_link'), ('', ''), ('r1/odöm', 'b')]


def on_the_wire(message):
    buffer = io.BytesIO()
    serialize_message(buffer, SEQ, message)
    return buffer.getvalue()


@pytest.mark.parametrize(('frame', 'child'), FRAMES)
def test_odometry(frame, child):
    message = OdometryMessage(child_frame_id=child)
    message.header.frame_id, message.header.stamp = frame, STAMP
    fill_pose(message.pose.pose, POSE)
    fill_twist(message.twist.twist, TWIST)
    pose_variances, twist_variances = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0), (0.0, 0.5, 1.5, 2.5, 3.5, 4.5)
    message.pose.covariance[::7], message.twist.covariance[::7] = pose_variances, twist_variances
    layout = OdometryLayout(frame, child, pose_variances, twist_variances)
    assert layout.pack(SEQ, NOW_NS, Odometry(POSE, TWIST)) == on_the_wire(message)


@pytest.mark.parametrize(('parent', 'child'), FRAMES)
def test_a_transform(parent, child):
    edge = TransformStamped(child_frame_id=child)
    edge.header.frame_id, edge.header.stamp = parent, STAMP
    fill_transform(edge.transform, POSE)
    assert TransformLayout(parent, child).pack(NOW_NS, POSE) == on_the_wire(TFMessage([edge]))


@pytest.mark.parametrize('ranges', [[1.5, math.inf, 0.1], []])
def test_a_laser_scan(ranges):
    message = LaserScan(
        angle_min=-0.5,
        angle_max=0.5,
        angle_increment=0.25,
        range_min=0.125,
        range_max=30.0,
        ranges=ranges,
        intensities=[0.0, 1500.0][: len(ranges)],
    )
    message.header.frame_id, message.header.stamp = 'läser', STAMP
    packed = LaserScanLayout('läser').pack(
        SEQ,
        NOW_NS,
        (-0.5, 0.5, 0.25),
        (0.125, 30.0),
        np.array(ranges),
        np.array(message.intensities),
    )
    assert packed == on_the_wire(message)


@pytest.mark.parametrize('points', [[(1.5, math.inf, 0.1), (0.0, -2.0, 3.0)], []])
def test_a_point_cloud(points):
    shine = [750.0, 0.0][: len(points)]
    message = PointCloud(
        points=[Point32(*point) for point in points], channels=[ChannelFloat32('', shine)]
    )
    message.header.frame_id, message.header.stamp = 'laser', STAMP
    packed = PointCloudLayout('laser').pack(
        SEQ, NOW_NS, np.array(points).reshape(-1, 3), np.array(shine)
    )
    assert packed == on_the_wire(message)


def test_an_imu():
    message = Imu()
    message.header.frame_id, message.header.stamp = 'imu_link', STAMP
    variances = {
        'orientation': (-1.0, -1.0, 0.5),
        'angular_velocity': (1.0, 2.0, 3.0),
        'linear_acceleration': (4.0, 5.0, 6.0),
    }
    for field, values in (
        ('orientation', POSE.orientation),
        ('angular_velocity', TWIST.angular),
        ('linear_acceleration', TWIST.linear),
    ):
        for axis, value in zip('xyzw', values, strict=False):
            setattr(getattr(message, field), axis, value)
        getattr(message, f'{field}_covariance')[::4] = variances[field]
    reading = ImuReading(POSE.orientation, TWIST.angular, TWIST.linear, sum(variances.values(), ()))
    assert ImuLayout('imu_link').pack(SEQ, NOW_NS, reading) == on_the_wire(message)


@pytest.mark.parametrize(
    'reading',
    [
        JointStates(('right', 'rädchen'), (0.5, 1.5)),
        JointStates((), ()),
        JointStates(('steering', 'left'), (0.5, 1.5), (0.1, 0.2), (0.0, 3.0)),
    ],
)
def test_joint_states_have_velocities_and_efforts_if_given(reading):
    message = JointState(None, *reading)
    message.header.stamp = STAMP
    assert JointStatesLayout(reading).pack(SEQ, NOW_NS, reading) == on_the_wire(message)


def test_sequence_numbers_continue_those_of_rospy_and_wrap_around():
    publisher = SimpleNamespace(impl=SimpleNamespace(seq=7))
    assert [next_number(publisher), next_number(publisher)] == [8, 9]
    publisher.impl.seq = 2**32 - 1
    assert next_number(publisher) == 0


def test_closed_publisher_has_no_sequence_number():
    assert next_number(SimpleNamespace(impl=None)) == 0
