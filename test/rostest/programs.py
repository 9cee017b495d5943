"""Programs of packages: where they are, and what they print."""

import os
from functools import cache
from pathlib import Path

from roslib.packages import find_node


@cache
def find_program(package, name):
    """Return the path of a program, as `rosrun` finds it; that asks anew, for half a second."""
    found = find_node(package, name)
    assert found, f'no program {name} in {package}'
    return found[0]


def keep(printed, name, process):
    """Add what a program has printed to the logs, which tools/rostests.py searches for errors."""
    if printed and (folder := os.environ.get('ROS_LOG_DIR')):
        log = Path(folder, f'{name.strip("/")}-{process.pid}-printed.log')
        log.write_text(printed, encoding='utf-8')
