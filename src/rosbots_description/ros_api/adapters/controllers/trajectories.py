"""The topics, action and service of trajectory controllers, in the namespace of each.

Subscribes:
    <ns>/<controller>/command (trajectory_msgs/JointTrajectory)
Publishes:
    <ns>/<controller>/state (control_msgs/JointTrajectoryControllerState)
Actions:
    <ns>/<controller>/follow_joint_trajectory (control_msgs/FollowJointTrajectoryAction)
Services:
    <ns>/<controller>/query_state (control_msgs/QueryTrajectoryState)
"""

import logging
from collections.abc import Callable, Sequence
from typing import cast

import rospy
from control_msgs import srv
from control_msgs.msg import (
    FollowJointTrajectoryAction,
    FollowJointTrajectoryFeedback,
    FollowJointTrajectoryGoal,
    FollowJointTrajectoryResult,
    JointTolerance,
    JointTrajectoryControllerState,
)
from trajectory_msgs.msg import JointTrajectory

from ....sim.controllers import (
    FollowedGoal,
    JointTrajectoryController,
    Tolerance,
    Trajectory,
    TrajectoryGoal,
    TrajectoryPoint,
)
from ....sim.core import SimError
from ..adapter import Adapter
from ..declarations import Offers, Publishes, Subscribes
from .actions import Acts
from .topics import connects_controller
from .trajectory_messages import fill_state

logger = logging.getLogger(__name__)


def read_trajectory(message: JointTrajectory) -> Trajectory:
    """Return the trajectory of a message."""
    return Trajectory(
        tuple(message.joint_names),
        [
            TrajectoryPoint(
                point.positions,
                point.velocities,
                point.accelerations,
                point.time_from_start.to_sec(),
            )
            for point in message.points
        ],
        message.header.stamp.to_nsec(),
    )


def read_tolerances(messages: Sequence[JointTolerance]) -> dict[str, Tolerance]:
    """Return tolerances by the names of joints."""
    return {one.name: Tolerance(one.position, one.velocity, one.acceleration) for one in messages}


def follow(controller: JointTrajectoryController, goal: FollowJointTrajectoryGoal) -> FollowedGoal:
    """Pass a goal on to the controller."""
    return controller.follow(
        TrajectoryGoal(
            read_trajectory(goal.trajectory),
            read_tolerances(goal.path_tolerance),
            read_tolerances(goal.goal_tolerance),
            goal.goal_time_tolerance.to_sec(),
        )
    )


def result(goal: FollowedGoal) -> FollowJointTrajectoryResult:
    """Return the result of a goal that has ended."""
    return FollowJointTrajectoryResult(goal.error_code, goal.error_string)


def offer_query(adapter: Adapter, name: str) -> Callable[[], None]:
    """Offer the service that tells the desired state at a time."""
    controller = cast(JointTrajectoryController, adapter.plugin)

    def answer(request: srv.QueryTrajectoryStateRequest) -> srv.QueryTrajectoryStateResponse:
        try:
            point = adapter.server.loop.call(lambda: controller.query(request.time.to_nsec()))
        except SimError as error:
            logger.error('%s', error)
            raise rospy.ServiceException(str(error)) from None
        return srv.QueryTrajectoryStateResponse(list(controller.joint_names), *map(list, point[:3]))

    shutdown: Callable[[], None] = rospy.Service(name, srv.QueryTrajectoryState, answer).shutdown
    return shutdown


connects_controller(
    JointTrajectoryController,
    Subscribes('play', JointTrajectory, lambda message: (read_trajectory(message),)),
    Publishes(
        'state',
        JointTrajectoryControllerState,
        convert=lambda state: fill_state(JointTrajectoryControllerState(), state),
        frame='',
    ),
    Acts(
        FollowJointTrajectoryAction,
        follow,
        JointTrajectoryController.cancel,
        result,
        lambda state: fill_state(FollowJointTrajectoryFeedback(), state),
    ),
    Offers('query_state', offer_query),
)
