"""Calls to the simulator's services, with a deadline."""

from typing import Any

import genpy
import rospy

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
    answer = answer_of(name, kind, timeout, **request)
    if not getattr(answer, 'success', True):
        raise SimError(answer.status_message)
    return answer


def answer_of(
    name: str, kind: type[Any], timeout: float = TIMEOUT, /, **request: object
) -> genpy.Message:
    """Return the answer of such a service, also if it refused.

    Raises:
        SimError: it was not reached, or did not answer in time.
    """
    service = rospy.resolve_name(f'gazebo/{name}')
    try:
        return interruptibly(lambda: rospy.ServiceProxy(service, kind)(**request), timeout)
    except (rospy.ServiceException, rospy.ROSException) as error:
        raise SimError(f'{service}: {error}') from error
