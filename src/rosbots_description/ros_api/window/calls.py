"""Calls to the simulator's services, with a deadline."""

from typing import Any

import genpy
import rospy
from rosbots_msgs.srv import GetModelOmissions

from ...sim.core import SimError
from ..clients.gazebo_interface import interruptibly

TIMEOUT = 10.0  # for an answer [s, wall]


def call(
    name: str, kind: type[Any], timeout: float = TIMEOUT, /, **request: object
) -> genpy.Message:
    """Return the answer of a service of the simulator `gazebo` of this node's namespace.

    Raises:
        SimError: it was not reached, did not answer in time, or refused.
    """
    service = rospy.resolve_name(f'gazebo/{name}')
    try:
        answer = interruptibly(lambda: rospy.ServiceProxy(service, kind)(**request), timeout)
    except (rospy.ServiceException, rospy.ROSException) as error:
        raise SimError(f'{service}: {error}') from error
    if not getattr(answer, 'success', True):
        raise SimError(answer.status_message)
    return answer


def model_omissions(name: str) -> list[str]:
    """Return the parts that a model was spawned without, each in a few words; [] of a light."""
    service = rospy.resolve_name('gazebo/get_model_omissions')
    try:
        answer = interruptibly(
            lambda: rospy.ServiceProxy(service, GetModelOmissions)(name), TIMEOUT
        )
    except (rospy.ServiceException, rospy.ROSException) as error:
        raise SimError(f'{service}: {error}') from error
    return list(answer.omissions)
