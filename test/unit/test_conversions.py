"""Values to messages and back, with the real message classes."""

import math

import pytest
from geometry_msgs.msg import Point, Quaternion
from geometry_msgs.msg import Pose as PoseMessage
from geometry_msgs.msg import Twist as TwistMessage
from nav_msgs.msg import Odometry as OdometryMessage

from rosbots_description.ros_api.conversions import (
    fill_odometry,
    fill_pose,
    fill_transform,
    fill_twist,
    joint_state_message,
    read_pose,
    stamp,
    transform_message,
)
from rosbots_description.sim.pose import Pose, Twist
from rosbots_description.sim.readings import JointStates, Odometry

HALF = math.sqrt(0.5)
POSE = Pose((1.0, -2.0, 3.0), (HALF, 0.0, 0.0, HALF))
TWIST = Twist((0.1, 0.2, 0.3), (0.4, 0.5, 0.6))


def test_a_stamp_is_exact_to_the_nanosecond():
    time = stamp(12_000_000_345)
    assert (time.secs, time.nsecs) == (12, 345)


def test_a_pose_goes_there_and_back():
    message = PoseMessage()
    fill_pose(message, POSE)
    assert (message.orientation.x, message.orientation.w) == (HALF, HALF)
    assert read_pose(message).position == POSE.position
    assert read_pose(message).orientation == pytest.approx(POSE.orientation)


def test_a_twist_is_written_component_by_component():
    message = TwistMessage()
    fill_twist(message, TWIST)
    assert (message.linear.y, message.angular.z) == (0.2, 0.6)


def test_a_quaternion_of_zeros_means_no_rotation():
    assert read_pose(PoseMessage()).orientation == (0.0, 0.0, 0.0, 1.0)


def test_a_quaternion_is_normalised():
    message = PoseMessage(Point(), Quaternion(0.0, 0.0, 2.0, 0.0))
    assert read_pose(message).orientation == (0.0, 0.0, 1.0, 0.0)


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
def test_a_pose_that_is_not_finite_is_refused(bad):
    with pytest.raises(ValueError, match='not finite'):
        read_pose(PoseMessage(Point(0.0, bad, 0.0), Quaternion(0.0, 0.0, 0.0, 1.0)))
    with pytest.raises(ValueError, match='not finite'):
        read_pose(PoseMessage(Point(), Quaternion(0.0, 0.0, 0.0, bad)))


def test_odometry_keeps_the_frames_of_its_message():
    message = OdometryMessage(child_frame_id='base')
    message.header.frame_id = 'odom'
    fill_odometry(message, 5_000_000, Odometry(POSE, TWIST))
    assert (message.header.frame_id, message.child_frame_id) == ('odom', 'base')
    assert message.header.stamp.nsecs == 5_000_000
    assert message.pose.pose.position.y == -2.0
    assert message.twist.twist.angular.z == 0.6


def test_a_transform_goes_from_parent_to_child():
    message = transform_message('odom', 'base')
    fill_transform(message, 7, POSE)
    assert (message.header.frame_id, message.child_frame_id) == ('odom', 'base')
    assert message.header.stamp.nsecs == 7
    assert (message.transform.translation.z, message.transform.rotation.x) == (3.0, HALF)


def test_joint_states_have_positions_only():
    message = joint_state_message(9, JointStates(('right', 'left'), (1.0, 2.0)))
    assert (message.name, message.position) == (['right', 'left'], [1.0, 2.0])
    assert (message.velocity, message.effort) == ([], [])
    assert message.header.stamp.nsecs == 9
