"""Frames of sensors, by TF."""

import ctypes
import gc
from types import SimpleNamespace

import pytest
import rospy
from support.wire import transforms
from tf2_msgs.msg import TFMessage

from rosbots_description.ros_api.window.frames import TOPICS, FrameFinder
from rosbots_description.sim.core import IDENTITY, Pose

VISITS = 500


class Mallinfo(ctypes.Structure):
    """glibc's mallinfo2: ten numbers, of which the eighth is `uordblks`."""

    _fields_ = (('numbers', ctypes.c_size_t * 10),)


def allocated():
    """Return what is allocated in this process by C and C++ [bytes]."""
    gc.collect()
    libc = ctypes.CDLL(None)
    libc.mallinfo2.restype = Mallinfo
    return libc.mallinfo2().numbers[7]


class Topics:
    """Those that somebody listens to, in place of ROS's."""

    def __init__(self):
        self.readers = {}

    def subscribe(self, topic, kind, callback, more):
        assert kind is TFMessage
        assert topic not in self.readers
        self.readers[topic] = lambda message: callback(message, more)
        return SimpleNamespace(unregister=lambda: self.readers.pop(topic))

    def say(self, parent, child, x=0.0, static=True):
        self.readers[TOPICS[static]](transforms((parent, child, Pose((x, 0.0, 0.0)))))


@pytest.fixture
def topics(monkeypatch):
    topics = Topics()
    monkeypatch.setattr(rospy, 'Subscriber', topics.subscribe)
    return topics


@pytest.fixture
def finder(topics):
    return FrameFinder()


def test_a_link_is_its_own_frame_and_nobody_listens(finder, topics):
    assert finder.locate('laser', {'laser', 'base'}) == ('laser', IDENTITY)
    assert finder.locate('/laser', {'laser'}) == ('laser', IDENTITY)
    assert not topics.readers


def test_a_frame_is_found_on_the_nearest_link_above(finder, topics):
    links = {'base', 'wheel'}
    assert finder.locate('lens', links) is None
    assert set(topics.readers) == set(TOPICS)
    topics.say('camera', 'lens', 0.5)
    topics.say('/odom', '/base', 7.0, static=False)
    assert finder.locate('lens', links) is None  # TF does not tell yet where the camera is
    topics.say('/base', '/camera', 1.0)
    link, pose = finder.locate('lens', links)
    assert (link, pose.position) == ('base', (1.5, 0.0, 0.0))
    assert not topics.readers  # it has found everything


def test_listening_goes_on_until_all_are_found(finder, topics):
    assert finder.locate('a', {'base'}) is None
    assert finder.locate('odom', {'base'}) is None
    topics.say('base', 'a')
    assert finder.locate('a', {'base'})
    assert topics.readers
    finder.forget()
    assert not topics.readers


def test_a_prefix_is_the_robots_name_or_none_of_a_link(finder, topics):
    assert finder.locate('r2/laser', {'base'}) is None
    topics.say('r2/base', 'r2/laser', 0.1)
    assert finder.locate('r2/laser', {'base', 'r1/base', 'r2/base'})[0] == 'r2/base'
    assert finder.locate('r2/laser', {'base'})[0] == 'base'


def test_a_frame_above_a_link_is_found_from_there_and_followed(finder, topics):
    links = {'base', 'wheel'}
    assert finder.locate('map', links) is None
    topics.say('map', 'odom', 1.0, static=False)
    topics.say('odom', 'base', 5.0, static=False)
    topics.say('base', 'wheel', 0.2, static=False)  # the way from it is longer
    link, pose = finder.locate('map', links)
    assert (link, pose.position) == ('base', (-6.0, 0.0, 0.0))
    topics.say('map', 'odom', 2.0, static=False)
    assert finder.locate('map', links)[1].position == (-7.0, 0.0, 0.0)
    assert finder.locate('/odom', links)[1].position == (-5.0, 0.0, 0.0)
    finder.forget()
    assert not topics.readers


@pytest.mark.parametrize('edges', [('odom base', 'world map'), ('b map', 'map b')])
def test_a_frame_beside_all_links_or_in_a_loop_is_not_found(finder, topics, edges):
    assert finder.locate('map', {'base'}) is None
    for edge in edges:
        topics.say(*edge.split())
    assert finder.locate('map', {'base'}) is None


def test_another_robot_is_looked_for_anew(finder, topics):
    assert finder.locate('laser', {'base'}) is None
    late = topics.readers['/tf_static']
    topics.say('base', 'laser', 0.1)
    assert finder.locate('laser', {'base'})
    finder.forget()
    assert finder.locate('laser', {'base'}) is None
    late(transforms(('base', 'laser', IDENTITY)))  # it was under way
    assert finder._parents == {}


def test_visits_leave_nothing_behind(finder, topics):
    # What tf2's buffer leaves is not Python's, so what C++ has allocated counts.
    def visit():
        assert finder.locate('laser', {'base'}) is None
        topics.say('base', 'laser', 0.1)
        assert finder.locate('laser', {'base'})
        finder.forget()

    visit()
    before = allocated()
    for _ in range(VISITS):
        visit()
    assert allocated() - before < VISITS * 100
