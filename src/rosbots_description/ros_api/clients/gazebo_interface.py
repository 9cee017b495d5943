"""Client side of Gazebo's services: spawn a model, set its joints.

Names, arguments, log lines and results are those of the module ``gazebo_ros.gazebo_interface``,
from which existing scripts import these functions.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future, wait
from typing import Any, TypeVar

import rospy
from gazebo_msgs.srv import SetModelConfiguration, SpawnModel
from genpy import Message
from geometry_msgs.msg import Pose

from ..transport import is_running

_POLL = 0.05  # [s] wall time between polls of the shutdown flag

Result = TypeVar('Result')


def interruptibly(function: Callable[[], Result], timeout: float = math.inf) -> Result:
    """Return function(), but stop waiting for it when the node is shut down.

    rospy blocks in a socket during a service call and does not react to Ctrl-C. So the function
    runs on a separate thread, which may be abandoned.

    Args:
        timeout: longest time to wait [s, wall].
    Raises:
        rospy.ROSInterruptException: the node was shut down first.
        rospy.ROSException: `timeout` has passed.
        Exception: whatever the function raises.
    """
    outcome: Future[Result] = Future()

    def run() -> None:
        try:
            outcome.set_result(function())
        except Exception as error:  # raised on the caller's thread below
            outcome.set_exception(error)

    threading.Thread(target=run, daemon=True).start()
    give_up = time.monotonic() + timeout
    while not wait((outcome,), _POLL).done:
        if time.monotonic() > give_up:
            raise rospy.ROSException(f'no answer within {timeout} s')
        if rospy.is_shutdown():  # not `is_running`: what is called on shutdown is awaited, too
            raise rospy.ROSInterruptException('shut down while waiting')
    return outcome.result()


def _call(service: str, service_class: type[Any], *request: object) -> Message | None:
    """Wait without limit for the service and call it.

    Returns:
        The response, or None after a call error (which is logged).
    Raises:
        rospy.ROSInterruptException: the node was shut down first.
    """
    rospy.loginfo('Waiting for service %s', service)
    interruptibly(lambda: rospy.wait_for_service(service))
    rospy.loginfo('Calling service %s', service)
    try:
        return interruptibly(lambda: rospy.ServiceProxy(service, service_class)(*request))
    except rospy.ServiceException as error:
        if not is_running():
            raise rospy.ROSInterruptException('shut down during the call') from error
        rospy.logerr('Service call failed: %s', error)
        return None


def _report(what: str, response: Message | None) -> bool | None:
    """Log the status of a response; return whether it worked, None after a call error."""
    if response is None:
        return None
    rospy.loginfo(f'{what} status: %s', response.status_message)
    return bool(response.success)


def spawn_sdf_model_client(
    model_name: str,
    model_xml: str,
    robot_namespace: str,
    initial_pose: Pose,
    reference_frame: str,
    gazebo_namespace: str,
) -> bool | None:
    """Spawn a model given as SDF; wait for the simulator without a time limit.

    Args:
        robot_namespace: namespace for the model's plugins that do not set one themselves.
        initial_pose: pose [m, quaternion x y z w] in reference_frame.
        reference_frame: name of an entity; empty, 'world' or 'map' for the world frame.
        gazebo_namespace: namespace of the simulator's services, usually '/gazebo'.
    Returns:
        Whether it worked, None after a call error (both are logged).
    Raises:
        rospy.ROSInterruptException: the node was shut down first.
    """
    service = gazebo_namespace + '/spawn_sdf_model'
    request = model_name, model_xml, robot_namespace, initial_pose, reference_frame
    return _report('Spawn', _call(service, SpawnModel, *request))


def spawn_urdf_model_client(
    model_name: str,
    model_xml: str,
    robot_namespace: str,
    initial_pose: Pose,
    reference_frame: str,
    gazebo_namespace: str,
) -> bool | None:
    """Spawn a model given as URDF; otherwise like spawn_sdf_model_client."""
    service = gazebo_namespace + '/spawn_urdf_model'
    request = model_name, model_xml, robot_namespace, initial_pose, reference_frame
    return _report('Spawn', _call(service, SpawnModel, *request))


def set_model_configuration_client(
    model_name: str,
    model_param_name: str,
    joint_names: Sequence[str],
    joint_positions: Sequence[float],
    gazebo_namespace: str,
) -> bool | None:
    """Set joint positions [rad or m] of a model; wait for the simulator without a time limit.

    Args:
        model_param_name: passed on; simulators do not use it.
    Returns:
        Whether it worked, None after a call error (both are logged).
    Raises:
        rospy.ROSInterruptException: the node was shut down first.
    """
    service = gazebo_namespace + '/set_model_configuration'
    request = model_name, model_param_name, list(joint_names), list(joint_positions)
    return _report('Set model configuration', _call(service, SetModelConfiguration, *request))
