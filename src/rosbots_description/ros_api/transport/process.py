"""Starts and ends this process as a node: without long waits, whatever its environment."""

import os
import socket
import time
from collections.abc import Sequence
from types import SimpleNamespace

import rospy
import rospy.impl.init
from rosgraph.network import get_address_override
from rospy.impl import registration
from rospy.impl.paramserver import get_param_server_cache

from .log_file import disable_log_file, log_file, tolerate_full_disk, write_error
from .polling import close_pollers

_WITHOUT_TOPICS = '/rosout_disable_topics_generation'  # a parameter of rospy
_POLL_PERIOD = 0.001  # between polls of the node's registration [s, wall]


def init_node(name: str, arguments: Sequence[str], **options: bool) -> None:
    """Start the node as `rospy.init_node` does, even without a log file or a resolvable hostname.

    Args:
        name: of the node.
        arguments: the command line without the program's name, for ROS remappings.
        options: of `rospy.init_node`.
    """
    lost_name = _address_without_name()
    path = log_file(name, arguments)
    reason = write_error(path)
    _begin_at_once()
    _register_until_the_end()
    close_pollers()
    rospy.init_node(name, [name, *arguments, *(disable_log_file() if reason else ())], **options)
    _end_at_once()
    _remember_parameter()
    tolerate_full_disk()
    if reason:
        rospy.logwarn(
            'log file %s cannot be written (%s), so there is none; set ROS_LOG_DIR to a '
            'writable folder',
            path,
            reason,
        )
    if lost_name:
        rospy.logwarn(
            'the hostname %s cannot be resolved, so only programs on this machine can '
            'reach this node; add it to /etc/hosts, or set ROS_HOSTNAME or ROS_IP',
            lost_name,
        )


def init_anonymous_node(name: str, arguments: Sequence[str]) -> None:
    """Start a node with a unique name that leaves signals, /clock and /rosout alone."""
    init_node(
        name,
        arguments,
        anonymous=True,
        disable_signals=True,
        disable_rostime=True,
        disable_rosout=True,
    )


def is_node() -> bool:
    """Tell whether this process has become a node."""
    return bool(rospy.core.is_initialized())


def _address_without_name() -> str | None:
    """Use localhost as this node's address if the hostname cannot be resolved.

    rospy would advertise the hostname, to which nobody could connect.

    Returns:
        The hostname in that case; None if it resolves or the user has set an address.
    """
    name = socket.gethostname()
    if get_address_override():
        return None
    try:
        socket.getaddrinfo(name, None)
    except (OSError, UnicodeError):  # UnicodeError: not a valid hostname
        os.environ['ROS_HOSTNAME'] = 'localhost'
        return name
    return None


def _begin_at_once() -> None:
    """Start 0.1 s faster.

    rospy polls the node's registration at that period, and the first poll is always too early.
    There is no public API for this.
    """
    rospy.impl.init.time = SimpleNamespace(sleep=lambda _seconds: time.sleep(_POLL_PERIOD))


def _register_until_the_end() -> None:
    """Let registrations that no master takes end when the node is told to.

    rospy lets them go on until it calls the node shut down, which comes after its clean-up. But
    they hold the lock of all topics, for which the clean-up waits: the node would never end. There
    is no public API for this.
    """
    registration.is_shutdown = rospy.core.is_shutdown_requested


def _end_at_once() -> None:
    """Shut down up to 0.5 s faster.

    rospy's registration thread checks only every 0.5 s whether the node is shutting down, and the
    shutdown waits for it. There is no public API to wake it.
    """
    # Collected now: rospy clears the list before the hook runs.
    conditions = [
        listener.cond
        for listener in registration.get_registration_listeners().listeners
        if hasattr(listener, 'cond')
    ]

    def wake(_reason: str) -> None:
        for condition in conditions:
            with condition:
                condition.notify_all()

    rospy.core.add_shutdown_hook(wake)


def _remember_parameter() -> None:
    """Read the parameter that rospy needs for each message to /rosout, without subscribing to it.

    rospy would subscribe, which it never takes back: the master would keep the address of a node
    that has ended, and shut down whoever has it by the time that the name is registered again. If
    the parameter is not set, rospy would even ask for each message, and a master that does not
    answer would stop the simulation. There is no public API for its cache.
    """
    value = rospy.get_param(_WITHOUT_TOPICS, False)
    get_param_server_cache().set(_WITHOUT_TOPICS, value)
