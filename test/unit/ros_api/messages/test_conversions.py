"""Values to messages and back, with the real message classes."""

import math

import pytest
from geometry_msgs.msg import Point, Quaternion
from geometry_msgs.msg import Pose as PoseMessage
from geometry_msgs.msg import Twist as TwistMessage

from rosbots_description.ros_api.messages.conversions import (
    fill_pose,
    fill_twist,
    read_pose,
    stamp,
)
from rosbots_description.sim.core.transforms import Pose, Twist

HALF = math.sqrt(0.5)
POSE = Pose((1.0, -2.0, 3.0), (HALF, 0.0, 0.0, HALF))
TWIST = Twist((0.1, 0.2, 0.3), (0.4, 0.5, 0.6))


def test_a_stamp_is_exact_to_the_nanosecond():
    time = stamp(12_000_000_345)
    assert (time.secs, time.nsecs) == (12, 345)


def test_pose_survives_conversion_to_a_message_and_back():
    message = PoseMessage()
    fill_pose(message, POSE)
    assert (message.orientation.x, message.orientation.w) == (HALF, HALF)
    assert read_pose(message).position == POSE.position
    assert read_pose(message).orientation == pytest.approx(POSE.orientation)


def test_twist_is_converted_component_by_component():
    message = TwistMessage()
    fill_twist(message, TWIST)
    assert (message.linear.y, message.angular.z) == (0.2, 0.6)


def test_zero_quaternion_is_the_identity():
    assert read_pose(PoseMessage()).orientation == (0.0, 0.0, 0.0, 1.0)


def test_a_quaternion_is_normalised():
    message = PoseMessage(Point(), Quaternion(0.0, 0.0, 2.0, 0.0))
    assert read_pose(message).orientation == (0.0, 0.0, 1.0, 0.0)


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
def test_pose_that_is_not_finite_is_rejected(bad):
    with pytest.raises(ValueError, match='not finite'):
        read_pose(PoseMessage(Point(0.0, bad, 0.0), Quaternion(0.0, 0.0, 0.0, 1.0)))
    with pytest.raises(ValueError, match='not finite'):
        read_pose(PoseMessage(Point(), Quaternion(0.0, 0.0, 0.0, bad)))
