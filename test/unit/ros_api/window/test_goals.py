"""Goals and initial poses as messages, to the topics that take them."""

import math
from types import SimpleNamespace

import pytest
import rospy
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped

from rosbots_description.ros_api.window import goals as module
from rosbots_description.ros_api.window.goals import RosGoals
from rosbots_description.sim.core import Pose

POSE = Pose((1.0, 2.0, 0.0), (0.0, 0.0, 1.0, 0.0))


SUBSCRIBED = {
    '/a': 'geometry_msgs/PoseStamped',
    '/initialpose': 'geometry_msgs/PoseWithCovarianceStamped',
    '/cmd_vel': 'geometry_msgs/Twist',
    '/move_base_simple/goal': 'geometry_msgs/PoseStamped',
}


@pytest.fixture
def goals():
    return RosGoals(SimpleNamespace(subscribed=lambda: SUBSCRIBED))


@pytest.fixture
def sent(monkeypatch):
    sent = []

    def commands(*made_for):
        return SimpleNamespace(publish=lambda message: sent.append((*made_for, message)))

    monkeypatch.setattr(module, 'Commands', commands)
    monkeypatch.setattr(rospy.Time, 'now', lambda: rospy.Time(7))
    return sent


def test_topics_are_by_type_and_those_of_move_base_and_amcl_come_first(goals):
    assert goals.goal_topics() == ['/move_base_simple/goal', '/a']
    assert goals.estimate_topics() == ['/initialpose']


def test_a_goal_has_its_pose_frame_and_time(goals, sent):
    goals.send_goal('/a', 'map', POSE)
    ((topic, kind, message),) = sent
    assert (topic, kind) == ('/a', PoseStamped)
    assert (message.header.frame_id, message.header.stamp) == ('map', rospy.Time(7))
    assert (message.pose.position.x, message.pose.position.y) == (1.0, 2.0)
    assert (message.pose.orientation.z, message.pose.orientation.w) == (1.0, 0.0)


def test_an_initial_pose_is_as_uncertain_as_rvizs(goals, sent):
    goals.send_estimate('/initialpose', 'map', POSE)
    ((_, kind, message),) = sent
    assert kind is PoseWithCovarianceStamped
    assert message.pose.pose.position.y == 2.0
    uncertain = {index: value for index, value in enumerate(message.pose.covariance) if value}
    assert uncertain == pytest.approx({0: 0.25, 7: 0.25, 35: (math.pi / 12.0) ** 2})
