"""Velocity commands: none is lost while the first robot connects."""

import pytest
import rospy

from rosbots_description.ros_api.window.commands import Commands
from rosbots_description.ros_api.window.robots import RosRobots


class FakePublisher:
    """A topic to which a test connects robots."""

    def __init__(self, _topic, _kind, listener, queue_size):
        self.listener, self.most = listener, queue_size
        self.connections, self.received = 0, []

    def get_num_connections(self):
        return self.connections

    def publish(self, command):
        self.received.append((command.linear.x, command.angular.z))

    def connect(self):
        self.connections += 1
        self.listener.peer_subscribe('/cmd_vel', self.publish, self.publish)


@pytest.fixture
def made(monkeypatch):
    made = []

    def publisher(*arguments, **options):
        made.append(FakePublisher(*arguments, **options))
        return made[-1]

    monkeypatch.setattr(rospy, 'Publisher', publisher)
    return made


def test_commands_wait_for_the_robot_that_connects_first(made):
    drive = RosRobots(None).drive
    drive('/cmd_vel', 0.5, 1.0)
    drive('/cmd_vel', 0.0, 0.0)
    (publisher,) = made
    assert publisher.received == []
    publisher.connect()
    publisher.connect()  # another one
    assert publisher.received == [(0.5, 1.0), (0.0, 0.0)]
    drive('/cmd_vel', 0.25, 0.0)
    assert publisher.received[2:] == [(0.25, 0.0)]


def test_of_those_that_wait_the_last_and_its_stop_stay(made):
    drive = RosRobots(None).drive
    for forward in (1.0, 2.0, 3.0, 0.0):
        drive('/cmd_vel', forward, 0.0)
    made[0].connect()
    assert made[0].received == [(3.0, 0.0), (0.0, 0.0)]
    assert made[0].most >= 2  # rospy passes both on


def test_rospy_calls_a_listener_of_this_kind():
    assert issubclass(Commands, rospy.SubscribeListener)


def test_a_robot_that_connected_before_the_listener_is_served(made):
    drive = RosRobots(None).drive
    drive('/cmd_vel', 1.0, 0.0)
    made[0].connections = 1
    drive('/cmd_vel', 0.0, 0.0)
    assert made[0].received == [(1.0, 0.0), (0.0, 0.0)]
