"""Names of topics and frames in a plugin's namespace."""

import pytest

from rosbots_description.ros_api.transport.names import frame_name, is_valid_name, topic_name


@pytest.mark.parametrize(
    ('namespace', 'topic', 'expected'),
    [
        ('/', 'odom', '/odom'),
        ('/', '/part2_cmr/cmd_vel', '/part2_cmr/cmd_vel'),
        ('/r1/', 'cmd_vel', '/r1/cmd_vel'),
        ('rosbots', 'odom', '/rosbots/odom'),
        ('//r1', 'a//b', '/r1/a/b'),
        ('r1', '//a//b/', '/a/b'),
        ('r1', '', '/r1'),
        ('1st', '2_B', '/1st/2_B'),
        ('~r1', 'odom', '/unnamed/r1/odom'),
        ('r1', '/-1', '/-1'),
    ],
)
def test_topic_is_resolved_in_its_namespace_unless_global(namespace, topic, expected):
    assert topic_name(namespace, topic) == expected


@pytest.mark.parametrize(
    ('namespace', 'topic'),
    [
        ('a b', 'odom'),
        ('ü', 'odom'),
        ('/', '\uff4fdom'),
        ('/', ''),
        ('/', '//'),
        ('/', '~private'),
        ('/', 'a:b'),
        ('/', 'a/~b'),
        ('/', 'odom\n'),
        ('/', 'odom\0'),
        ('my-robot', 'odom'),
        ('/', '/../../../etc/passwd'),
        ('/', '; id'),
        ('/', '٣'),
    ],
)
def test_name_that_ros_rejects_is_not_valid(namespace, topic):
    assert not is_valid_name(topic_name(namespace, topic))


@pytest.mark.parametrize(
    ('prefix', 'frame', 'expected'),
    [
        ('', 'odom', 'odom'),
        ('r1', 'odom', 'r1/odom'),
        ('/r1', 'odom', 'r1/odom'),
        ('r1', '/world', 'world'),
        ('', '/world', 'world'),
    ],
)
def test_frame_gets_the_prefix_unless_it_begins_with_a_slash(prefix, frame, expected):
    assert frame_name(prefix, frame) == expected


@pytest.mark.parametrize('name', ['/odom', '/r1/odom', '/1st/2_B', '/_/__x', '/' + 1000 * 'x'])
def test_name_that_ros_accepts_is_valid(name):
    assert is_valid_name(name)
