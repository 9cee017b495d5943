"""Messages that wait to be taken."""

import pytest
import rospy

from rosbots_description.ros_api.window import feed as module
from rosbots_description.ros_api.window.feed import Feed


class FakeSubscriber:
    def __init__(self, topic, kind, callback, **_options):
        self.topic, self.send, self.is_open = topic, callback, True

    def unregister(self):
        self.is_open = False


@pytest.fixture
def now(monkeypatch):
    """Return the time, as a list of one."""
    now = [100.0]
    monkeypatch.setattr(rospy, 'Subscriber', FakeSubscriber)
    monkeypatch.setattr(module.time, 'monotonic', lambda: now[0])
    return now


def test_the_newest_message_waits(now):
    feed = Feed('/t', str)
    assert feed.take() == []
    for message in 'abc':
        feed._subscriber.send(message)
        now[0] += 1.0
    assert feed.take() == [(102.0, 'c')]
    assert feed.take() == []
    feed.close()
    assert not feed._subscriber.is_open


def test_of_each_period_the_last_message_is_kept(now):
    feed = Feed('/t', int, kept=3, period=0.5)
    for number in range(20):
        feed._subscriber.send(number)
        now[0] += 0.125
    assert feed.take() == [(101.375, 11), (101.875, 15), (102.375, 19)]
