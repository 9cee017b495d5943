"""Starts the ROS node of a client program."""

from __future__ import annotations

import logging
import signal
import threading
import time
from collections.abc import Mapping, Sequence
from types import FrameType
from typing import Any

import rosgraph
import rospy

from .master import is_master_running, require_address
from .process import init_node

logger = logging.getLogger(__name__)

_RETRY = 0.5  # [s] wall time between two tries to reach the master


def start_node(
    name: str, arguments: Sequence[str], anonymous: bool = False, wall_time: bool = False
) -> None:
    """Wait for the ROS master as long as it takes, then start the node.

    rospy waits for the master too, but then Ctrl-C takes seconds and ends in a traceback. Signals
    shut the node down on a separate thread: rospy would do so within the signal handler, which
    takes 5 s if the main thread holds a lock, such as that of /rosout. So functions of
    rospy.on_shutdown run concurrently with the main thread.

    Args:
        name: of the node.
        arguments: the command line without the program's name, for ROS remappings.
        anonymous: make the name unique, unless the command line gives one with __name.
        wall_time: do not follow /clock.

    Raises:
        KeyboardInterrupt: Ctrl-C while waiting.
        AddressError: ROS_MASTER_URI is not a valid address, or not that of a ROS master.
    """
    require_address()
    if not is_master_running(f'/{name}'):
        # Without a node, logging writes to standard error.
        logger.warning(
            'No ROS master at %s. Start roscore; waiting for it.', rosgraph.get_master_uri()
        )
        while not is_master_running(f'/{name}'):
            time.sleep(_RETRY)
    init_node(name, arguments, anonymous=anonymous, disable_signals=True, disable_rostime=wall_time)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, _shut_down)


def own_parameters(defaults: Mapping[str, Any]) -> dict[str, Any]:
    """Return the node's private parameters by name, with defaults for those not set."""
    return {name: rospy.get_param(f'~{name}', default) for name, default in defaults.items()}


def is_running() -> bool:
    """Tell whether the node is not shutting down."""
    return not rospy.core.is_shutdown_requested()  # before topics and services are closed


def _shut_down(number: int, _frame: FrameType | None) -> None:
    threading.Thread(target=rospy.signal_shutdown, args=(f'signal {number}',)).start()
