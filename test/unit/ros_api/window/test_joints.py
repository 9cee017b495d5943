"""Topics of commands to controllers, and what is published on them."""

from types import SimpleNamespace
from typing import ClassVar

import pytest
import rospy

from rosbots_description.ros_api.window import joints as module
from rosbots_description.ros_api.window.joints import RosJoints
from rosbots_description.sim.description import CommandTopic

NUMBER, ARRAY = 'std_msgs/Float64', 'std_msgs/Float64MultiArray'
TRAJECTORY = 'trajectory_msgs/JointTrajectory'
PARAMETERS = {
    '/group': {'joints': ['a', 'b'], 'type': 'position_controllers/JointGroupPositionController'},
    '/force': {'joints': ['a'], 'type': 'effort_controllers/JointGroupEffortController'},
    '/arm': {'joints': ['a', 'b'], 'type': 'effort_controllers/JointTrajectoryController'},
    '/odd': {'joints': 'a'},
}


class FakePublisher:
    """Remembers what is published, and whether it has ended."""

    made: ClassVar[list] = []

    def __init__(self, topic, kind, latch, queue_size):
        self.topic, self.data_class, self.sent, self.ended = topic, kind, [], False
        self.made.append(self)

    def publish(self, message):
        assert isinstance(message, self.data_class)
        self.sent.append(message)

    def unregister(self):
        self.ended = True


@pytest.fixture
def graph():
    """Topics that other nodes subscribe to, with their types."""
    graph = SimpleNamespace(topics={})
    graph.subscribed = lambda: graph.topics
    return graph


@pytest.fixture
def joints(graph, monkeypatch):
    monkeypatch.setattr(FakePublisher, 'made', [])
    monkeypatch.setattr(module.rospy, 'Publisher', FakePublisher)
    monkeypatch.setattr(module.rospy, 'get_param', PARAMETERS.get)
    return RosJoints(graph)


def test_controllers_are_offered_with_their_joints(graph, joints):
    graph.topics = {
        '/one/command': NUMBER,
        '/group/command': ARRAY,
        '/force/command': ARRAY,
        '/arm/command': TRAJECTORY,
        '/cmd_vel': 'geometry_msgs/Twist',
    }
    assert joints.command_topics() == [
        CommandTopic('/one/command'),
        CommandTopic('/group/command', ('a', 'b'), True),
        CommandTopic('/force/command', ('a',)),
        CommandTopic('/arm/command', ('a', 'b'), True),
    ]


@pytest.mark.parametrize('name', ['/odd/command', '/nowhere/command', '/arm/other'])
def test_topics_without_a_list_of_joints_are_left_out(graph, joints, name):
    graph.topics = {name: ARRAY}
    assert joints.command_topics() == []


def test_values_are_published_as_the_controller_takes_them(graph, joints):
    graph.topics = {'/one/command': NUMBER, '/group/command': ARRAY, '/arm/command': TRAJECTORY}
    values = (1.0,), (1.0, 2.0), (3.0, 4.0)
    for topic, of_topic in zip(joints.command_topics(), values, strict=True):
        joints.command(topic, of_topic)
    one, group, arm = (publisher.sent[0] for publisher in FakePublisher.made)
    assert (one.data, group.data) == (1.0, (1.0, 2.0))
    assert arm.joint_names == ('a', 'b')
    assert arm.header.stamp == rospy.Time(0)  # at once
    assert arm.points[0].positions == (3.0, 4.0)
    assert arm.points[0].time_from_start == rospy.Duration(1)


def test_a_topic_of_another_type_gets_another_publisher(graph, joints):
    for kind in (ARRAY, TRAJECTORY, TRAJECTORY):
        graph.topics = {'/arm/command': kind}
        joints.command(joints.command_topics()[0], (1.0, 2.0))
    first, second = FakePublisher.made
    assert first.ended
    assert len(second.sent) == 2


def test_parameters_are_asked_for_once_while_a_topic_is_there(joints, graph, monkeypatch):
    asked = []
    monkeypatch.setattr(
        module.rospy,
        'get_param',
        lambda name, default: asked.append(name) or PARAMETERS.get(name, default),
    )
    graph.topics = {'/group/command': ARRAY, '/nothing': ARRAY}
    first = joints.command_topics()
    assert joints.command_topics() == first == [CommandTopic('/group/command', ('a', 'b'), True)]
    assert asked == ['/group', '/nothing']
    graph.topics = {}
    joints.command_topics()
    graph.topics = {'/group/command': TRAJECTORY}
    joints.command_topics()
    assert asked[2:] == ['/group']
