"""Names of topics and frames in a plugin's namespace."""

import pytest

from rosbots_description.ros_api.names import frame_name, topic_name


@pytest.mark.parametrize(('namespace', 'topic', 'expected'), [
    ('/', 'odom', '/odom'),
    ('/', '/part2_cmr/cmd_vel', '/part2_cmr/cmd_vel'),
    ('/r1/', 'cmd_vel', '/r1/cmd_vel'),
    ('rosbots', 'odom', 'rosbots/odom'),
    ('//r1', 'a//b', '/r1/a/b'),
])
def test_a_topic_stands_in_its_namespace_unless_it_is_global(namespace, topic, expected):
    assert topic_name(namespace, topic) == expected


@pytest.mark.parametrize(('prefix', 'frame', 'expected'), [
    ('', 'odom', 'odom'),
    ('r1', 'odom', 'r1/odom'),
    ('/r1', 'odom', 'r1/odom'),
    ('r1', '/world', 'world'),
    ('', '/world', 'world'),
])
def test_a_frame_takes_the_prefix_unless_it_begins_with_a_slash(prefix, frame, expected):
    assert frame_name(prefix, frame) == expected
