"""The topics of controllers, in the namespace of each.

Subscribes:
    <ns>/<controller>/command (std_msgs/Float64): controllers of one joint
    <ns>/<controller>/command (std_msgs/Float64MultiArray): controllers of a group of joints
    <ns>/<controller>/cmd_vel (geometry_msgs/Twist): drives
    <ns>/<controller>/cmd_four_wheel_steering (four_wheel_steering_msgs/FourWheelSteering)
Publishes:
    <ns>/joint_states (sensor_msgs/JointState): joint_state_controller
    <ns>/<controller>/state (control_msgs/JointControllerState): PIDs of one joint
    <ns>/<controller>/odom (nav_msgs/Odometry), /tf (tf2_msgs/TFMessage): drives; and cmd_vel_out
        (geometry_msgs/TwistStamped) if publish_cmd, wheel_joint_controller_state
        (control_msgs/JointTrajectoryControllerState) if publish_wheel_joint_controller_state
    <ns>/<controller>/odom_steer (four_wheel_steering_msgs/FourWheelSteeringStamped)
Services and more:
    <ns>/<controller>/<pid>/...: the gains of each PID, see `reconfigure.gains`
    <ns>/<controller>/...: settings of diff_drive_controller, see `reconfigure.diff_drive`
"""

import logging
from collections.abc import Callable, Mapping
from typing import cast

import rospy
from control_msgs.msg import JointControllerState, JointTrajectoryControllerState
from four_wheel_steering_msgs.msg import FourWheelSteering, FourWheelSteeringStamped
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray
from tf2_msgs.msg import TFMessage

from ....sim.controllers import (
    Controller,
    DiffDriveController,
    DriveController,
    FourWheelSteeringController,
    JointCommandController,
    JointGroupCommandController,
    JointGroupPositionController,
    JointPidState,
    JointPositionController,
    JointStateController,
    JointVelocityController,
    MecanumDriveController,
    Pid,
)
from ....sim.controllers import FourWheelSteering as AxleSteering
from ....sim.core import Twist as Velocity
from ...messages import OdometryLayout, TransformLayout, fill_twist
from ...transport import topic_name
from ..adapter import Adapter, owner_name
from ..declarations import Declaration, Endpoint, Offers, Publishes, Serializer, Subscribes, finite
from ..registry import declare_topics
from ..serializers import JointStatesSerializer
from .trajectory_messages import fill_state

logger = logging.getLogger(__name__)


class GainsEndpoint(Endpoint):
    """The gains of a controller's PIDs: a server of dynamic_reconfigure for each."""

    def open(self) -> None:
        """Advertise the gains."""
        controller = cast(Controller, self.adapter.plugin)
        open_gains(self.adapter, controller.pids)


def open_gains(adapter: Adapter, pids: Mapping[str, Pid]) -> None:
    """Advertise gains, by their paths in the namespace; called on the registrar's thread."""
    from ...reconfigure.gains import serve_gains

    if adapter.is_closed:
        return
    for path, pid in pids.items():
        name = topic_name(adapter.plugin.namespace, path)
        try:
            server = serve_gains(pid, name, adapter.server.loop.post)
        except rospy.ServiceException:
            logger.warning(
                '%s: there is a server of dynamic_reconfigure in %s already',
                owner_name(adapter.plugin),
                name,
            )
        else:
            adapter.on_close(server.close)


def connects_controller(owner: type[Controller], *declared: Declaration) -> None:
    """Give the controllers of a class these topics, and those of their gains."""
    declare_topics(owner, *declared, GainsEndpoint)


def twist_message(twist: Velocity) -> TwistStamped:
    """Return a velocity command after its limits as a message."""
    message = TwistStamped()
    fill_twist(message.twist, twist)
    return message


def pid_state_message(state: JointPidState) -> JointControllerState:
    """Return the state of a PID as a message; as upstream its clamp is that of i_clamp_max."""
    gains = state.gains
    return JointControllerState(
        set_point=state.set_point,
        process_value=state.process_value,
        process_value_dot=state.process_value_dot,
        error=state.error,
        time_step=state.time_step,
        command=state.command,
        p=gains.p,
        i=gains.i,
        d=gains.d,
        i_clamp=gains.i_max,
        antiwindup=gains.antiwindup,
    )


def steering_message(steering: AxleSteering) -> FourWheelSteeringStamped:
    """Return the measured steering of both axles as a message."""
    return FourWheelSteeringStamped(
        data=FourWheelSteering(
            speed=steering.speed,
            front_steering_angle=steering.front_angle,
            rear_steering_angle=steering.rear_angle,
        )
    )


def odometry_serializer(adapter: Adapter) -> Serializer:
    """Return the function that serialises a drive's odometry; its frames take no prefix."""
    drive = cast(DriveController, adapter.plugin)
    return OdometryLayout(*_frames(drive), drive.pose_variances, drive.twist_variances).pack


def transform_serializer(adapter: Adapter) -> Serializer:
    """Return the function that serialises the transform of a drive."""
    layout = TransformLayout(*_frames(cast(DriveController, adapter.plugin)))
    return lambda _number, now_ns, edge: layout.pack(now_ns, edge.pose)


def _frames(drive: DriveController) -> tuple[str, str]:
    values = drive.params.values
    return str(values['odom_frame_id']), str(values['base_frame_id'])


def offer_settings(adapter: Adapter, name: str) -> Callable[[], None]:
    """Offer the settings of a diff_drive_controller to dynamic_reconfigure."""
    from ...reconfigure.diff_drive import serve_settings

    controller = cast(DiffDriveController, adapter.plugin)
    return serve_settings(controller, name, adapter.server.loop.post).close


# The argument of `command` is a number, or one for each joint.
SINGLE, GROUP = (
    Subscribes('command', kind, lambda message: (message.data,))
    for kind in (Float64, Float64MultiArray)
)
STATE = Publishes('state', JointControllerState, convert=pid_state_message, frame='')
COMMAND, SIDEWAYS = (
    Subscribes('command', Twist, finite(*fields))
    for fields in (('linear.x', 'angular.z'), ('linear.x', 'angular.z', 'linear.y'))
)
ODOMETRY = (
    Publishes('odometry', Odometry, serializer=odometry_serializer, queue=100),
    Publishes('odometry_transform', TFMessage, serializer=transform_serializer, queue=100),
    Publishes('limited_command', TwistStamped, convert=twist_message, frame='', queue=100),
)

connects_controller(Controller)
connects_controller(
    JointStateController,
    Publishes('joint_states', JointState, serializer=JointStatesSerializer, queue=1000),
)
connects_controller(JointCommandController, SINGLE)
connects_controller(JointPositionController, SINGLE, STATE)
connects_controller(JointVelocityController, SINGLE, STATE)
connects_controller(JointGroupCommandController, GROUP)
connects_controller(JointGroupPositionController, GROUP)
connects_controller(DriveController, COMMAND, *ODOMETRY)
connects_controller(
    DiffDriveController,
    COMMAND,
    *ODOMETRY,
    Offers('', offer_settings),
    Publishes(
        'wheel_states',
        JointTrajectoryControllerState,
        frame='',
        queue=100,
        convert=lambda state: fill_state(JointTrajectoryControllerState(), state),
    ),
)
connects_controller(MecanumDriveController, SIDEWAYS, *ODOMETRY)
connects_controller(
    FourWheelSteeringController,
    COMMAND,
    *ODOMETRY,
    Subscribes(
        'steer', FourWheelSteering, finite('speed', 'front_steering_angle', 'rear_steering_angle')
    ),
    Publishes('steering', FourWheelSteeringStamped, convert=steering_message, frame='', queue=100),
)
