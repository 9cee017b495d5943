"""Names of topics and frames, resolved as the plugins of gazebo_ros_pkgs resolve them."""

import re
from typing import cast

import rosgraph
import rospy
from rosgraph.names import resolve_name

from .master import retry_call

# Global names that every node accepts, as ros::names::validate of roscpp has them.
_GLOBAL_NAME = re.compile('(/[a-zA-Z0-9_]+)+')


def topic_name(namespace: str, topic: str) -> str:
    """Return the global name, before remapping, of a `topic` in a plugin's namespace.

    Repeated slashes collapse, and a leading one is kept; ~ stands for this node's namespace.
    """
    given = topic if topic.startswith('/') else f'{namespace}/{topic}'
    return str(resolve_name(re.sub('/+', '/', given), rospy.get_name()))


def is_valid_name(name: str) -> bool:
    """Tell whether a global name is one that ROS accepts for a topic or service."""
    return bool(_GLOBAL_NAME.fullmatch(name))


def frame_name(prefix: str, frame: str) -> str:
    """Return `frame` with a tf prefix, as tf::resolve; no prefix after a leading slash."""
    if frame.startswith('/'):
        return frame[1:]
    prefix = prefix.lstrip('/')
    return f'{prefix}/{frame}' if prefix else frame


def find_tf_prefix(namespace: str) -> str:
    """Return the parameter tf_prefix, searched from `namespace` upward; '' if there is none.

    Waits while there is no ROS master.
    """
    name = search_parameter(namespace, 'tf_prefix')
    return '' if name is None else str(read_parameter(name, ''))


def search_parameter(namespace: str, parameter: str) -> str | None:
    """Return the global name of a parameter, searched from `namespace` upward; None: not found.

    Waits while there is no ROS master.
    """
    namespace = rospy.resolve_name(namespace).rstrip('/')
    try:
        # The master searches upward from the caller's name.
        return cast(
            str, retry_call(lambda: rosgraph.Master(f'{namespace}/plugin').searchParam(parameter))
        )
    except rosgraph.MasterError:
        return None


def read_parameter(name: str, default: object = None) -> object:
    """Return the value of a parameter, or `default`; waits while there is no ROS master."""
    return retry_call(lambda: rospy.get_param(name, default))
