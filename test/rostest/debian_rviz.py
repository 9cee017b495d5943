"""What tests need to know of Debian's RViz 1.14, where no program of ours starts it.

With software rendering it now and then overwrites its own heap while it opens its window, also
where only Debian's programs run. So it is started again if it crashed before its window stood.
"""

import re

import rospy
from rosnode import rosnode_ping
from simulator import wait_until

STARTS = 4  # at most
CRASH = re.compile(r'rviz-\d+\] (process )?has died.*?exit code -(6|11),', re.S)
STANDS = '/rviz/reload_shaders'  # the first service that it opens after its window


def stands(node='/rviz'):
    """Tell whether RViz has its window, reads TF and lives."""
    _, readers, services = rospy.get_master().getSystemState()[2]
    return any(topic == '/tf' and node in nodes for topic, nodes in readers) \
        and any(service == STANDS for service, _ in services) \
        and rosnode_ping(node, max_count=1, skip_cache=True)  # else one that has crashed


def start(open_terminal, close, limit):
    """Return the terminal of a launch file whose RViz stands.

    Args:
        open_terminal: launches it, in a terminal that it returns.
        close: ends what runs in a terminal.
        limit: in which one or the other happens [s, wall].
    """
    for _ in range(STARTS):
        terminal = open_terminal()
        wait_until(lambda: stands() or CRASH.search(terminal.shown()), 'RViz', limit)  # noqa: B023
        if not CRASH.search(terminal.shown()):
            return terminal
        close(terminal)
    raise AssertionError(terminal.shown())
