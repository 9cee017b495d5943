"""The executable controller_group: sets of controllers that are started and stopped together.

Parameters:
    controller_groups: lists of controllers, by the names of groups
"""

from __future__ import annotations

import sys
from typing import cast

import rospy
from controller_manager_msgs.srv import ListControllers

from .calls import (
    RUNNING,
    call,
    load_controller,
    start_controller,
    start_stop_controllers,
)


def list_groups() -> None:
    """Print the groups with their controllers."""
    groups = _groups()
    sys.stdout.write(f'Number of groups: {len(groups)}\n')
    for name, controllers in sorted(groups.items()):
        sys.stdout.write(f'  {name}\n')
        sys.stdout.writelines(f'      {controller}\n' for controller in controllers)


def spawn(group: str) -> None:
    """Load and start the controllers of a group."""
    wanted, _ = _read(group)
    for name in wanted:
        load_controller(name)
    for name in wanted:
        start_controller(name)


def switch(group: str) -> None:
    """Stop the running controllers of other groups, and start those of this one, in one step.

    Those that are not loaded are loaded first; if one cannot be, nothing is switched.
    """
    wanted, others = _read(group)
    if not wanted:
        return
    running = {
        one.name: one.state == RUNNING
        for one in call('list_controllers', ListControllers).controller
    }
    for name in wanted:
        if name not in running and not load_controller(name):
            sys.stdout.write('Cancel group switching\n')
            return
    start_stop_controllers(
        [name for name in wanted if not running.get(name)],
        [name for name in others if running.get(name)],
    )


def _groups() -> dict[str, list[str]]:
    return cast(dict[str, list[str]], rospy.get_param('controller_groups', {}))


def _read(group: str) -> tuple[list[str], list[str]]:
    """Return the controllers of a group, and those of other groups only; logs if it has none."""
    groups = _groups()
    wanted = list(dict.fromkeys(groups.get(group, ())))
    if not wanted:
        rospy.logerr(f'There is no controller defined in group {group}')
    everything = dict.fromkeys(name for names in groups.values() for name in names)
    return wanted, [name for name in everything if name not in wanted]
