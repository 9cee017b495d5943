"""Frames of sensors, by TF."""

import pytest
import tf2_ros
from geometry_msgs.msg import TransformStamped

from rosbots_description.ros_api.window.frames import FrameFinder
from rosbots_description.sim.core import IDENTITY


class FakeListener:
    open = 0

    def __init__(self, _buffer):
        FakeListener.open += 1

    def unregister(self):
        FakeListener.open -= 1


@pytest.fixture
def finder(monkeypatch):
    monkeypatch.setattr(tf2_ros, 'TransformListener', FakeListener)
    FakeListener.open = 0
    return FrameFinder()


def hear(finder, parent, child, x=0.0, static=True):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    message.transform.translation.x = x
    message.transform.rotation.w = 1.0
    add = finder._buffer.set_transform_static if static else finder._buffer.set_transform
    add(message, 'test')


def test_a_link_is_its_own_frame_and_nobody_listens(finder):
    assert finder.locate('laser', {'laser', 'base'}) == ('laser', IDENTITY)
    assert finder.locate('/laser', {'laser'}) == ('laser', IDENTITY)
    assert FakeListener.open == 0


def test_a_frame_is_found_on_the_nearest_link_above(finder):
    links = {'base', 'wheel'}
    assert finder.locate('lens', links) is None
    assert FakeListener.open == 1
    hear(finder, 'camera', 'lens', 0.5)
    hear(finder, 'odom', 'base', 7.0, static=False)
    assert finder.locate('lens', links) is None  # TF does not tell yet where the camera is
    hear(finder, 'base', 'camera', 1.0)
    link, pose = finder.locate('lens', links)
    assert (link, pose.position) == ('base', (1.5, 0.0, 0.0))
    assert FakeListener.open == 0  # it has found everything


def test_listening_goes_on_until_all_are_found(finder):
    assert finder.locate('a', {'base'}) is None
    assert finder.locate('odom', {'base'}) is None
    hear(finder, 'base', 'a')
    assert finder.locate('a', {'base'})
    assert FakeListener.open == 1
    finder.forget()
    assert FakeListener.open == 0


def test_a_prefix_is_the_robots_name_or_none_of_a_link(finder):
    hear(finder, 'r2/base', 'r2/laser', 0.1)
    assert finder.locate('r2/laser', {'base', 'r1/base', 'r2/base'})[0] == 'r2/base'
    assert finder.locate('r2/laser', {'base'})[0] == 'base'


def test_a_loop_of_frames_ends(finder):
    hear(finder, 'b', 'a')
    hear(finder, 'a', 'b')
    assert finder.locate('a', {'base'}) is None


def test_another_robot_is_looked_for_anew(finder):
    hear(finder, 'base', 'laser', 0.1)
    assert finder.locate('laser', {'base'})
    finder.forget()
    assert finder.locate('laser', {'base'}) is None
