"""Names of topics and frames, resolved as the plugins of gazebo_ros_pkgs resolve them."""

import re

import rosgraph
import rospy
from rosgraph.names import resolve_name

from ...sim.core import PluginError
from .master import retry_call

# Global names that rospy and the master accept. roscpp rejects hyphens and dots.
_GLOBAL_NAME = re.compile('(/[a-zA-Z0-9_.-]+)+')
_PYTHON_ONLY = re.compile('[.-]')


def topic_name(namespace: str, topic: str) -> str:
    """Return the global name, before remapping, of a `topic` in a plugin's namespace.

    Repeated slashes collapse, and a leading one is kept; ~ stands for this node's namespace.

    Raises:
        PluginError: the result is not a valid ROS name.
    """
    given = topic if topic.startswith('/') else f'{namespace}/{topic}'
    name = resolve_name(re.sub('/+', '/', given), rospy.get_name())
    if not _GLOBAL_NAME.fullmatch(name):
        raise PluginError(
            f"'{name}' is not a valid topic name: use a-z, A-Z, 0-9 and _, separated by slashes; "
            "change the tags that it is made of, or the model's name"
        )
    return name


def is_for_all(topic: str) -> bool:
    """Tell whether C++ nodes, such as rviz, accept a topic of that name, too."""
    return not _PYTHON_ONLY.search(topic)


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
    namespace = rospy.resolve_name(namespace).rstrip('/')
    try:
        # The master searches upward from the caller's name.
        name = retry_call(lambda: rosgraph.Master(f'{namespace}/plugin').searchParam('tf_prefix'))
    except rosgraph.MasterError:
        return ''
    return str(retry_call(lambda: rospy.get_param(name, '')))
