"""Names of topics and frames in a plugin's namespace."""

import pytest

from rosbots_description.ros_api.transport.names import frame_name, is_for_all, topic_name
from rosbots_description.sim.core.errors import PluginError


@pytest.mark.parametrize(('namespace', 'topic', 'expected'), [
    ('/', 'odom', '/odom'),
    ('/', '/part2_cmr/cmd_vel', '/part2_cmr/cmd_vel'),
    ('/r1/', 'cmd_vel', '/r1/cmd_vel'),
    ('rosbots', 'odom', '/rosbots/odom'),
    ('//r1', 'a//b', '/r1/a/b'),
    ('r1', '//a//b/', '/a/b'),
    ('r1', '', '/r1'),
    ('1st', '2_B', '/1st/2_B'),
    ('~r1', 'odom', '/unnamed/r1/odom'),
    ('my-robot', 'v1.0', '/my-robot/v1.0'),
])
def test_topic_is_resolved_in_its_namespace_unless_global(namespace, topic, expected):
    assert topic_name(namespace, topic) == expected


@pytest.mark.parametrize(('namespace', 'topic'), [
    ('a b', 'odom'), ('a\nb', 'odom'), ('a::b', 'odom'), ('ü', 'odom'),
    ('/', ''), ('/', '/'), ('/', '//'), ('/', '~private'), ('/', 'a:b'),
    ('/', 'odom\n'),
])
def test_invalid_ros_name_is_rejected(namespace, topic):
    with pytest.raises(PluginError, match='is not a valid topic name'):
        topic_name(namespace, topic)


@pytest.mark.parametrize(('prefix', 'frame', 'expected'), [
    ('', 'odom', 'odom'),
    ('r1', 'odom', 'r1/odom'),
    ('/r1', 'odom', 'r1/odom'),
    ('r1', '/world', 'world'),
    ('', '/world', 'world'),
])
def test_frame_gets_the_prefix_unless_it_begins_with_a_slash(prefix, frame, expected):
    assert frame_name(prefix, frame) == expected


@pytest.mark.parametrize(('topic', 'expected'), [
    ('/r1/odom', True), ('/my-robot/odom', False), ('/v1.0/odom', False),
])
def test_name_is_valid_for_all_nodes_or_only_for_some(topic, expected):
    assert is_for_all(topic) is expected
