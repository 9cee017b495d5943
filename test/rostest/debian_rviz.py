"""Start of Debian's RViz 1.14 in tests, without our programs.

With software rendering it occasionally corrupts its heap while it opens its window, also
without any of our programs (cli/display.py says why). It is restarted if it crashes before its
window is open; a later end by the same heap, CRASH in what a terminal showed, is no fault of ours
either.
"""

import re
from pathlib import Path

import rospy
from rosnode import rosnode_ping
from simulator import wait_until

STARTS = 4  # at most
CRASH = re.compile(  # also of a required one
    r'(\x1b\[31m)?(=*REQUIRED process )?\[rviz-\d+\] (process )?has died'
    r'.*?exit code (-6|-11|134|139),',
    re.S,
)
READY_SERVICE = '/rviz/reload_shaders'  # the first service after its window
CONFIG = Path(__file__).resolve().parents[2] / 'config' / 'rosbots.rviz'
SAVED = '.rviz/default.rviz'  # in a home folder: what RViz opens without an argument
OFTEN, SELDOM = 'Frame Rate: 30', 'Frame Rate: 2'


def draw_seldom(path):
    """Write our view with few pictures per second: in software, 30 keep a processor busy."""
    text = CONFIG.read_text()
    assert OFTEN in text
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text.replace(OFTEN, SELDOM))


def is_ready(node='/rviz'):
    """Return whether RViz is running with its window open and subscribed to TF."""
    _, readers, services = rospy.get_master().getSystemState()[2]
    # not a crashed one
    return (
        any(topic == '/tf' and node in nodes for topic, nodes in readers)
        and any(service == READY_SERVICE for service, _ in services)
        and rosnode_ping(node, max_count=1, skip_cache=True)
    )


def start(open_terminal, limit):
    """Return the terminal of a launch file, once its RViz is ready.

    Args:
        open_terminal: launches the file and returns the terminal.
        limit: timeout of the start [s, wall].
    """
    for _ in range(STARTS):
        terminal = open_terminal()
        wait_until(lambda: is_ready() or CRASH.search(terminal.shown()), 'RViz', limit)  # noqa: B023
        if not CRASH.search(terminal.shown()):
            return terminal
        terminal.end()
    raise AssertionError(terminal.shown())
