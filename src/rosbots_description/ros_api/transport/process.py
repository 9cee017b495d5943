"""How our programs behave as nodes: they begin wherever they are, and end at once."""

import os
import socket
import time
from collections.abc import Sequence
from types import SimpleNamespace

import rospy
import rospy.impl.init
from rosgraph.network import get_address_override
from rospy.impl.registration import get_registration_listeners

from .log_file import log_file, log_to_nowhere, obstacle, outlive_full_disk

_LOOK = 0.001  # between two looks whether the master has taken the node in [s, wall]


def init_node(name: str, arguments: Sequence[str], **options: bool) -> None:
    """Start the node as `rospy.init_node` does, also without a log file or a name to be found by.

    Args:
        name: of the node.
        arguments: the command line without the program's name, for ROS remappings.
        options: of `rospy.init_node`.
    """
    lost_name = _address_without_name()
    path = log_file(name, arguments)
    reason = obstacle(path)
    _begin_at_once()
    rospy.init_node(name, [name, *arguments, *(log_to_nowhere() if reason else ())], **options)
    _end_at_once()
    outlive_full_disk()
    if reason:
        rospy.logwarn('log file %s cannot be written (%s), so there is none; set ROS_LOG_DIR to a '
                      'writable folder', path, reason)
    if lost_name:
        rospy.logwarn('the hostname %s cannot be resolved, so only programs on this machine can '
                      'reach this node; add it to /etc/hosts, or set ROS_HOSTNAME or ROS_IP',
                      lost_name)


def is_node() -> bool:
    """Tell whether this process has become a node."""
    return rospy.core.is_initialized()


def _address_without_name() -> str | None:
    """Let others find this node by localhost if this machine's name does not resolve.

    rospy would tell everybody that name, and nobody could connect.

    Returns:
        That name if so; None if all is well or the user has given an address.
    """
    name = socket.gethostname()
    if get_address_override():
        return None
    try:
        socket.getaddrinfo(name, None)
    except (OSError, UnicodeError):  # the latter for what cannot be a host's name at all
        os.environ['ROS_HOSTNAME'] = 'localhost'
        return name
    return None


def _begin_at_once() -> None:
    """Spare this process a tenth of a second at its beginning.

    rospy sleeps for so long before it looks again whether the master has taken the node in, and the
    first look always comes too soon. There is no public way.
    """
    rospy.impl.init.time = SimpleNamespace(sleep=lambda _seconds: time.sleep(_LOOK))


def _end_at_once() -> None:
    """Spare this process up to half a second at its end.

    rospy's registration thread looks only every 0.5 s whether the node is shutting down, and the
    shutdown waits for it. Waking it needs rospy's internals: there is no public way.
    """
    # Now, since rospy clears the list before the hook runs.
    conditions = [
        listener.cond for listener in get_registration_listeners().listeners
        if hasattr(listener, 'cond')
    ]

    def wake(_reason: str) -> None:
        for condition in conditions:
            with condition:
                condition.notify_all()

    rospy.core.add_shutdown_hook(wake)
