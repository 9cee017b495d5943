"""Curves of topics: which topics are subscribed to, and what is read of them."""

from types import SimpleNamespace

import pytest
from genpy import Time
from nav_msgs.msg import Odometry
from std_msgs.msg import Float64

from rosbots_description.ros_api.window import signals as module
from rosbots_description.ros_api.window.signals import RosSignals
from rosbots_description.sim.core import SimError

TYPES = {
    '/odom': 'nav_msgs/Odometry',
    '/odom/rate': 'std_msgs/Float64',
    '/name': 'std_msgs/String',
    '/strange': 'nowhere_msgs/None',
    '/any': '*',
}
SPEED = '/odom/twist/twist/linear/x'


class FakeFeed:
    def __init__(self, topic, kind, _kept, _period):
        self.kind, self.messages = kind, []
        FEEDS[topic] = self

    def take(self):
        taken, self.messages = self.messages, []
        return taken

    def close(self):
        FEEDS.pop(next(topic for topic, feed in FEEDS.items() if feed is self))


FEEDS = {}


@pytest.fixture
def signals(monkeypatch):
    FEEDS.clear()
    monkeypatch.setattr(module, 'Feed', FakeFeed)
    return RosSignals(SimpleNamespace(published=lambda: TYPES))


def test_topics_with_numbers_are_offered(signals):
    found = signals.signal_topics()
    assert found.keys() == {'/odom', '/odom/rate'}
    assert 'twist/twist/linear/x' in found['/odom']


def test_curves_of_one_topic_share_a_subscription(signals):
    other = '/odom/pose/pose/position/y'
    signals.open(SPEED)
    signals.open(other)
    assert list(FEEDS) == ['/odom']
    message = Odometry()
    message.header.stamp = Time(3, 500_000_000)
    message.twist.twist.linear.x, message.pose.pose.position.y = 0.5, 2.0
    FEEDS['/odom'].messages.append((77.0, message))
    assert signals.read() == {SPEED: [(3.5, 77.0, 0.5)], other: [(3.5, 77.0, 2.0)]}
    assert signals.read() == {SPEED: [], other: []}
    signals.close(SPEED)
    assert list(FEEDS) == ['/odom']
    signals.close(other)
    assert not FEEDS


def test_the_longest_name_of_a_topic_is_meant(signals):
    signals.open('/odom/rate/data')
    assert FEEDS['/odom/rate'].kind is Float64
    FEEDS['/odom/rate'].messages.append((77.0, Float64(4.0)))
    assert signals.read() == {'/odom/rate/data': [(None, 77.0, 4.0)]}  # it has no stamp


@pytest.mark.parametrize(
    ('curve', 'sentence'),
    [
        ('/gone/x', "No topic of '/gone/x' is published"),
        ('', "No topic of '' is published"),
        ('/odom', "No topic of '/odom' is published"),
        ('/odom/foo', "has no field 'foo'"),
        ('/strange/x', 'This machine has no messages nowhere_msgs/None, those of /strange'),
    ],
)
def test_what_cannot_be_plotted_is_told_and_not_read(signals, curve, sentence):
    with pytest.raises(SimError, match=sentence):
        signals.open(curve)
    assert not FEEDS
    assert signals.read() == {}
