"""The action of grippers, in the namespace of each controller.

Actions:
    <ns>/<controller>/gripper_cmd (control_msgs/GripperCommandAction); as upstream without feedback
"""

import logging

from control_msgs.msg import GripperCommandAction, GripperCommandGoal, GripperCommandResult

from ....sim.controllers import REJECTED, GripperActionController, GripperGoal
from .actions import Acts
from .topics import connects_controller

logger = logging.getLogger(__name__)


def follow(controller: GripperActionController, goal: GripperCommandGoal) -> GripperGoal:
    """Pass a goal on to the controller; one that is not finite is rejected."""
    try:
        return controller.follow(goal.command.position, goal.command.max_effort)
    except ValueError as error:
        logger.error('%s: %s', controller.name, error)
        rejected = GripperGoal()
        rejected.finish(REJECTED)
        return rejected


def result(goal: GripperGoal) -> GripperCommandResult:
    """Return the result of a goal that has ended."""
    return GripperCommandResult(*goal.result)


connects_controller(
    GripperActionController,
    Acts(GripperCommandAction, follow, GripperActionController.cancel, result),
)
