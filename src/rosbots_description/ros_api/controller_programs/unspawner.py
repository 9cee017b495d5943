"""The executable unspawner: keeps controllers stopped while it runs.

Services (called):
    controller_manager/list_controllers, controller_manager/switch_controller
"""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence

import rospy
from controller_manager_msgs.srv import ListControllers, SwitchController

from ..clients.gazebo_interface import interruptibly
from ..transport import is_running
from . import program
from .calls import BEST_EFFORT, MANAGER, RUNNING, call, switch

_PERIOD = 3.0  # [s] between two looks for controllers that somebody has started again
_POLL = 0.05  # [s] wall time between polls of the shutdown flag
_LAST_CALL = 5.0  # [s] wall time that each of the last two calls may take at the end


def run(names: Sequence[str], arguments: Sequence[str]) -> int:
    """Stop controllers until this program ends, and start them again then.

    Args:
        names: of the controllers.
        arguments: the whole command line, for ROS remappings.

    Returns:
        Exit code: 0; 1 if the controller manager ends meanwhile.
    """
    return program.run('unspawner', arguments, Unspawner(names).inhibit)


class Unspawner:
    """Controllers that are kept stopped."""

    def __init__(self, names: Sequence[str]) -> None:
        self._names = set(names)
        self._stopped: set[str] = set()
        self._ending = False
        self._stopping = threading.Lock()

    def inhibit(self) -> None:
        """Keep them stopped until the node is shut down; then start them again."""
        rospy.on_shutdown(self.start_again)
        while is_running():
            self.stop()
            begun = rospy.get_time()
            # The time may be set back.
            while is_running() and begun <= rospy.get_time() < begun + _PERIOD:
                time.sleep(_POLL)

    def stop(self) -> None:
        """Stop those that run.

        Raises:
            rospy.ServiceException: a call failed.
            rospy.ROSInterruptException: the node is shutting down.
        """
        running = {
            one.name
            for one in call('list_controllers', ListControllers).controller
            if one.state == RUNNING
        }
        found = sorted(self._names & running)
        with self._stopping:
            if found and not self._ending:
                rospy.loginfo(f'Inhibiting controllers: {", ".join(found)}')
                switch([], found, BEST_EFFORT)
                self._stopped.update(found)

    def start_again(self) -> None:
        """Start those that were stopped, while the node is shutting down."""
        # What is being stopped just now is started again, too, unless that takes too long.
        self._ending = True
        self._stopping.acquire(timeout=_LAST_CALL)
        if self._stopped:
            try:
                # Without waiting for a manager that was deleted.
                proxy = rospy.ServiceProxy(f'{MANAGER}/switch_controller', SwitchController)
                interruptibly(
                    lambda: proxy(start_controllers=sorted(self._stopped), strictness=BEST_EFFORT),
                    _LAST_CALL,
                )
            except (rospy.ServiceException, rospy.ROSException) as error:
                rospy.logwarn(f'unspawner: the controllers were not started again: {error}')
