"""States of joints along a trajectory as messages."""

from typing import TypeVar

from genpy import Duration, Message
from trajectory_msgs.msg import JointTrajectoryPoint

from ....sim.controllers import TrajectoryPoint, TrajectoryState
from ....sim.core import NANOSECONDS

Filled = TypeVar('Filled', bound=Message)


def fill_state(message: Filled, state: TrajectoryState) -> Filled:
    """Fill in a state or feedback, and return it."""
    message.joint_names = list(state.joint_names)
    message.desired, message.actual, message.error = map(
        _point, (state.desired, state.actual, state.error)
    )
    return message


def _point(point: TrajectoryPoint) -> JointTrajectoryPoint:
    return JointTrajectoryPoint(
        positions=list(point.positions),
        velocities=list(point.velocities),
        accelerations=list(point.accelerations),
        effort=list(point.efforts),
        time_from_start=Duration(nsecs=round(point.time_from_start * NANOSECONDS)),
    )
