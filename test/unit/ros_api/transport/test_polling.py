"""A closed topic leaves no descriptor behind."""

import os
import socket

import pytest
import rospy.topics

from rosbots_description.ros_api.transport.polling import ConnectionPoller, close_pollers


def open_pollers():
    """Return the number of epoll instances of this process."""
    found = 0
    for number in os.listdir('/proc/self/fd'):
        try:
            found += os.readlink(f'/proc/self/fd/{number}') == 'anon_inode:[eventpoll]'
        except FileNotFoundError:  # that of listdir
            continue
    return found


@pytest.mark.parametrize('kind', ['_PublisherImpl', '_SubscriberImpl'])
def test_closed_topics_leave_no_descriptor(monkeypatch, no_collection, kind):
    monkeypatch.setattr(rospy.topics, 'Poller', rospy.topics.Poller)  # restored after the test
    monkeypatch.setattr(rospy.topics._TopicImpl, 'close', rospy.topics._TopicImpl.close)
    close_pollers()
    before = open_pollers()
    topics = [getattr(rospy.topics, kind)(f'/t{number}', rospy.AnyMsg) for number in range(20)]
    assert open_pollers() == before + 20
    for topic in topics:
        topic.close()
        topic.close()  # as rospy does at its end
        topic.check()  # by another thread, which still has it
    assert open_pollers() == before


def test_a_lost_connection_is_found():
    poller = ConnectionPoller()
    here, there = socket.socketpair()
    with here, there:
        poller.add_fd(here.fileno())
        assert poller.error_iter() == []
        there.close()
        assert poller.error_iter() == [here.fileno()]
        poller.remove_fd(here.fileno())
        assert poller.error_iter() == []
    poller.close()


def test_a_closed_poller_finds_and_keeps_nothing():
    poller = ConnectionPoller()
    poller.close()
    poller.add_fd(0)
    poller.remove_fd(0)
    assert poller.error_iter() == []
