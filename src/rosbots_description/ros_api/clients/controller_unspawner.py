"""The executable unspawner: keeps controllers stopped while it runs.

Services (called):
    controller_manager/list_controllers, controller_manager/switch_controller
"""

from __future__ import annotations

import time
from collections.abc import Sequence

import rospy
from controller_manager_msgs.srv import ListControllers

from ..transport import is_running, start_node
from .controller_calls import BEST_EFFORT, RUNNING, call, switch

DONE, FAILED = 0, 1  # exit codes
_PERIOD = 3.0  # [s] between two looks for controllers that somebody has started again
_POLL = 0.05  # [s] wall time between polls of the shutdown flag


def run(names: Sequence[str], arguments: Sequence[str]) -> int:
    """Stop controllers until this program ends, and start them again then.

    Args:
        names: of the controllers.
        arguments: the whole command line, for ROS remappings.

    Returns:
        Exit code: 0; 1 if the controller manager ends meanwhile.
    """
    start_node('unspawner', arguments, anonymous=True)
    stopped: set[str] = set()
    rospy.on_shutdown(lambda: _start_again(stopped))
    try:
        while is_running():
            _stop(set(names), stopped)
            due = rospy.get_time() + _PERIOD
            while is_running() and rospy.get_time() < due:
                time.sleep(_POLL)
    except rospy.ROSInterruptException:
        pass
    except rospy.ServiceException as error:
        if is_running():
            rospy.logerr('unspawner: %s', error)
            return FAILED
    return DONE


def _stop(names: set[str], stopped: set[str]) -> None:
    running = {one.name for one in call('list_controllers', ListControllers).controller
               if one.state == RUNNING}
    found = sorted(names & running)
    if found:
        rospy.loginfo(f'Inhibiting controllers: {", ".join(found)}')
        switch([], found, BEST_EFFORT)
        stopped.update(found)


def _start_again(stopped: set[str]) -> None:
    if stopped:
        try:
            switch(sorted(stopped), [], BEST_EFFORT)
        except (rospy.ServiceException, rospy.ROSException) as error:
            rospy.logwarn(f'unspawner: the controllers were not started again: {error}')
