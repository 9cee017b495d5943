"""Names of topics and frames, resolved as the plugins of gazebo_ros_pkgs resolve them."""

import re

import rosgraph
import rospy


def topic_name(namespace: str, topic: str) -> str:
    """Return `topic` in a plugin's namespace; doubled slashes collapse, a leading one stays."""
    if topic.startswith('/'):
        return topic
    return re.sub('/+', '/', f'{namespace}/{topic}')


def frame_name(prefix: str, frame: str) -> str:
    """Return `frame` with a tf prefix, as tf::resolve does; a leading slash takes none."""
    if frame.startswith('/'):
        return frame[1:]
    prefix = prefix.lstrip('/')
    return f'{prefix}/{frame}' if prefix else frame


def find_tf_prefix(namespace: str) -> str:
    """Return the parameter tf_prefix, searched from `namespace` upward; '' if there is none."""
    namespace = rospy.resolve_name(namespace).rstrip('/')
    try:
        # The master searches upward from the name of who asks.
        name = rosgraph.Master(f'{namespace}/plugin').searchParam('tf_prefix')
    except rosgraph.MasterError:
        return ''
    return str(rospy.get_param(name, ''))
