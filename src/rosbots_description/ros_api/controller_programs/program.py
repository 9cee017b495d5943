"""A program that makes calls of a controller manager and ends."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import rospy

from ..transport import is_running, start_node

DONE, FAILED = 0, 1  # exit codes


def run(node: str, arguments: Sequence[str], act: Callable[[], None]) -> int:
    """Start a node, and return the exit code of `act()` in it.

    Returns:
        0, also after Ctrl-C; 1 if a call failed.
    """
    start_node(node, arguments, anonymous=True)
    try:
        act()
    except rospy.ROSInterruptException:
        return DONE
    except rospy.ServiceException as error:
        if is_running():
            rospy.logerr('%s: %s', node, error)
            return FAILED
    return DONE
