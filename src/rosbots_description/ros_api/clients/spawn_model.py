"""The executable spawn_model: reads the XML, spawns the model, and handles further flags."""

from __future__ import annotations

import argparse
import contextlib
import math
import sys
import threading
import time
from collections.abc import Sequence
from xml.sax.saxutils import escape

import rospy
from gazebo_msgs.msg import ModelStates
from gazebo_msgs.srv import DeleteModel
from geometry_msgs.msg import Point, Pose, Quaternion
from rosbots_msgs.srv import GetModelOmissions
from std_srvs.srv import Empty

from ...sim.core import from_rpy
from ..transport import AddressError, has_service, start_node
from .gazebo_interface import (
    interruptibly,
    set_model_configuration_client,
    spawn_sdf_model_client,
    spawn_urdf_model_client,
)
from .model_source import MissingFileError, SourceError, canonical_xml, read_file

DONE, FAILED, INTERRUPTED = 0, 1, 130  # exit codes

_SETTLE = 1.0  # [s] wall time for the joints to appear after the simulator's answer
_PATIENCE = 60.0  # [s] wall time for what was left out, on a busy machine
# As sent by Gazebo's client; the server searches its model path only.
_DATABASE = (
    '<sdf version="1.4"><world name="default"><include><uri>model://{}</uri></include>'
    '</world></sdf>'
)
_LISTED = 12  # omissions that are listed by name
_DELETE_TIMEOUT = 1.5  # [s] wall time, within the 2 s that Ctrl-C may take


def run(flags: argparse.Namespace, arguments: Sequence[str]) -> int:
    """Spawn a model according to spawn_model's flags.

    Args:
        flags: see cli.spawn_model; positions in m, angles in rad.
        arguments: the command line without the program's name, for ROS remappings.
    Returns:
        Exit code; every failure has been logged.

    Subscribes (with -wait):
        <gazebo_namespace>/model_states (gazebo_msgs/ModelStates)
    Calls:
        <gazebo_namespace>/spawn_urdf_model or spawn_sdf_model, set_model_configuration (-J),
        unpause_physics (-unpause), delete_model (-b); get_model_omissions if available
    """
    try:
        start_node('spawn_model', arguments, anonymous=True)
        if flags.wait and not _wait_for_model(flags.wait, flags.gazebo_namespace):
            return DONE  # as Gazebo's client: a shutdown here is no failure
        joints = _joint_positions(flags.joints)
        xml = canonical_xml(_fetch(flags), flags.package_to_model)
        return _spawn(flags, xml, joints)
    except MissingFileError as error:
        rospy.logfatal('%s', error)
        return FAILED
    except SourceError as error:
        rospy.logerr('%s', error)
        return FAILED
    except AddressError as error:  # without a node, it cannot be logged
        sys.stderr.write(f'spawn_model: {error}\n')
        return FAILED
    except (rospy.ROSInterruptException, KeyboardInterrupt):
        return INTERRUPTED


def _wait_for_model(name: str, gazebo_namespace: str) -> bool:
    """Return True once the model exists, False if the node is shut down first."""
    rospy.loginfo('Waiting for model %s before proceeding.', name)
    there = threading.Event()

    def receive(states: ModelStates) -> None:
        if name in states.name:
            there.set()

    subscriber = rospy.Subscriber(gazebo_namespace + '/model_states', ModelStates, receive)
    # Wall time: simulated time may be stopped.
    while not there.wait(0.1):
        if rospy.is_shutdown():
            return False
    subscriber.unregister()
    return True


def _joint_positions(pairs: list[list[str]]) -> dict[str, float]:
    """Return joint positions [rad or m] by name from the arguments of -J."""
    joints = {}
    for name, text in pairs:
        try:
            joints[name] = float(text)
        except ValueError:
            joints[name] = math.nan
        if not math.isfinite(joints[name]):
            raise SourceError(f'Error: -J {name} needs a position [rad or m], not {text!r}')
    return joints


def _fetch(flags: argparse.Namespace) -> bytes | str:
    """Return the XML from the source given by the flags."""
    if flags.file is not None:
        rospy.loginfo('Loading model XML from file %s', flags.file)
        return read_file(flags.file)
    if flags.param is not None:
        rospy.loginfo('Loading model XML from ros parameter %s', flags.param)
        return _read_parameter(flags.param)
    if flags.database is not None:
        rospy.loginfo('Loading model XML from Gazebo Model Database')
        return _DATABASE.format(escape(flags.database))
    rospy.loginfo('Loading model XML from stdin')
    text = sys.stdin.buffer.read()
    if not text.strip():
        raise SourceError('Error: stdin buffer was empty')
    return text


def _read_parameter(name: str) -> str:
    resolved = rospy.resolve_name(name)
    try:
        text = rospy.get_param(name)
    except KeyError as error:
        raise SourceError(
            f'Error: param does not exist or is empty: {resolved} was never set; '
            'load the model into it first'
        ) from error
    if not isinstance(text, str):
        raise SourceError(
            f'Error: param {resolved} holds {type(text).__name__}, not the XML text of a model'
        )
    if not text.strip():
        raise SourceError(f'Error: param does not exist or is empty: {resolved} is empty')
    return text


def _spawn(flags: argparse.Namespace, xml: str, joints: dict[str, float]) -> int:
    pose = Pose(Point(flags.x, flags.y, flags.z), Quaternion(*from_rpy(flags.R, flags.P, flags.Y)))
    namespace = flags.robot_namespace
    spawn = spawn_urdf_model_client if flags.urdf else spawn_sdf_model_client
    if not spawn(
        flags.model,
        xml,
        rospy.get_namespace() if namespace is None else namespace,
        pose,
        flags.reference_frame,
        flags.gazebo_namespace,
    ):
        rospy.logerr('Spawn service failed. Exiting.')
        return FAILED
    _log_omissions(flags.model, flags.gazebo_namespace)
    if joints and not _set_joints(flags, joints):
        rospy.logerr('SetModelConfiguration service failed. Exiting.')
        return FAILED
    if flags.unpause and not _unpause(flags.gazebo_namespace):
        return FAILED
    if flags.bond:
        rospy.on_shutdown(lambda: _delete(flags.model, flags.gazebo_namespace))
        rospy.loginfo('Waiting for shutdown to delete model %s', flags.model)
        rospy.spin()
    return DONE


def _log_omissions(model: str, gazebo_namespace: str) -> None:
    """Log what the simulator left out of the model, if it has a service for that.

    Gazebo has no such service, so errors are ignored.
    """
    service = rospy.resolve_name(gazebo_namespace + '/get_model_omissions')
    with contextlib.suppress(rospy.ServiceException, rospy.ROSException):
        if not has_service(service):
            return
        get_omissions = rospy.ServiceProxy(service, GetModelOmissions)
        omissions = interruptibly(lambda: get_omissions(model), timeout=_PATIENCE).omissions
        if omissions:
            more = f' and {len(omissions) - _LISTED} more' if len(omissions) > _LISTED else ''
            rospy.logwarn(
                'spawned without: %s%s; see doc/gazebo_compatibility.md and the log of '
                'the simulator',
                ', '.join(omissions[:_LISTED]),
                more,
            )


def _set_joints(flags: argparse.Namespace, joints: dict[str, float]) -> bool | None:
    rospy.loginfo('Giving the joints of %s %.0f s to appear', flags.model, _SETTLE)
    interruptibly(lambda: time.sleep(_SETTLE))
    return set_model_configuration_client(
        flags.model, '', list(joints), list(joints.values()), flags.gazebo_namespace
    )


def _unpause(gazebo_namespace: str) -> bool:
    rospy.loginfo('Unpausing physics')
    try:
        interruptibly(rospy.ServiceProxy(gazebo_namespace + '/unpause_physics', Empty))
    except rospy.ServiceException as error:
        rospy.logerr('Unpause physics service call failed: %s', error)
        return False
    return True


def _delete(name: str, gazebo_namespace: str) -> None:
    """Delete the model during rospy's shutdown, when services can still be called."""
    rospy.loginfo('Deleting model %s', name)
    delete = rospy.ServiceProxy(gazebo_namespace + '/delete_model', DeleteModel)
    try:
        response = interruptibly(lambda: delete(name), timeout=_DELETE_TIMEOUT)
    except (rospy.ServiceException, rospy.ROSException) as error:
        rospy.logerr('Delete model service call failed: %s', error)
        return
    if not response.success:
        rospy.logerr('Delete model service call failed: %s', response.status_message)
