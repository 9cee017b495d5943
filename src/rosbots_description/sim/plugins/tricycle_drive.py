"""The tricycle drive: one wheel that is steered and driven, two that are told by.

Behaviour, defaults and timing are those of libgazebo_ros_tricycle_drive.so in gazebo_ros_pkgs
2.9.2, with what is odd about it: `linear.x` is the speed of the driven wheel's rim and `angular.z`
the steering angle; speeding up goes by `wheelDeceleration`, slowing down by `wheelAcceleration`,
both in rad/s^2; encoder odometry turns the wrong way round, and its speeds are those in the
odometry frame. It steers towards the angle asked for; upstream's leaves it while it drives forward
and the angle is to become less.
"""

import logging
import math
from dataclasses import dataclass

from ..errors import PluginError
from ..pose import Twist
from ..readings import FrameTransform, JointStates, Odometry, Port
from .drive import (
    ENCODER,
    Drive,
    DriveConfig,
    Encoders,
    above_zero,
    as_rate,
    odometry_source,
    wheel_transforms,
    world_odometry,
)
from .params import Params
from .registry import register

logger = logging.getLogger(__name__)

STRAIGHT_ACROSS = math.pi / 2.0  # [rad] to which steering is limited


@dataclass(frozen=True)
class TricycleConfig(DriveConfig):
    """The plugin's tags, read and checked."""

    steering_joint: str
    driven_joint: str
    left_joint: str
    right_joint: str
    driven_diameter: float  # [m]
    encoder_diameter: float  # [m]
    encoder_separation: float  # [m]
    torque: float  # [N m] of the driven wheel and of steering
    acceleration: float  # [rad/s^2] of the driven wheel as it slows down; 0: no limit to either
    deceleration: float  # [rad/s^2] as it speeds up
    speed_tolerance: float  # [rad/s] within which the wheel goes on as it does
    steering_speed: float  # [rad/s]; not above 0: at once
    angle_tolerance: float  # [rad] within which steering stops
    odometry_source: str  # ENCODER or WORLD
    publish_wheel_tf: bool
    publish_wheel_joint_state: bool
    ros_debug_level: str


@register('libgazebo_ros_tricycle_drive.so')
class TricycleDrive(Drive):
    """Steer and drive one wheel; report odometry.

    Outputs, each a `Port`: `odometry`, `wheel_transform` (once per joint) and `joint_states`:
    steering, driven, left, right. `joints` are in that order.
    """

    prefix = 'TricycleDrive(ns = {}/): '

    def read_config(self, params: Params) -> TricycleConfig:
        """Read all tags with upstream's defaults."""
        read = params.read
        acceleration = read('wheelAcceleration', 0.0)
        return TricycleConfig(
            ros_debug_level=read('rosDebugLevel', 'na'),
            command_topic=read('commandTopic', 'cmd_vel'),
            odometry_topic=read('odometryTopic', 'odom'),
            odometry_frame=read('odometryFrame', 'odom'),
            robot_base_frame=read('robotBaseFrame', 'base_link'),
            update_rate=as_rate(params, 'updateRate', read('updateRate', 100.0)),
            steering_joint=read('steeringJoint', 'front_steering_joint'),
            driven_joint=read('actuatedWheelJoint', 'front_wheel_joint'),
            left_joint=read('encoderWheelLeftJoint', 'left_wheel_joint'),
            right_joint=read('encoderWheelRightJoint', 'right_wheel_joint'),
            driven_diameter=_length(params, 'actuatedWheelDiameter', 0.15),
            encoder_diameter=_length(params, 'encoderWheelDiameter', 0.15),
            encoder_separation=_length(params, 'encoderWheelSeparation', 0.5),
            torque=read('wheelTorque', 5.0),
            acceleration=acceleration,
            deceleration=read('wheelDeceleration', acceleration),
            speed_tolerance=read('wheelSpeedTolerance', 0.01),
            steering_speed=read('steeringSpeed', 0.0),
            angle_tolerance=read('steeringAngleTolerance', 0.01),
            odometry_source=odometry_source(params),
            publish_wheel_tf=read('publishWheelTF', False),
            publish_wheel_joint_state=read('publishWheelJointState', False),
        )

    def find_joints(self) -> None:
        """Find the four joints.

        Raises:
            PluginError: one of them is missing.
        """
        config = self.config
        self.wheel_transform, self.joint_states = Port(), Port()
        names = (config.steering_joint, config.driven_joint, config.left_joint, config.right_joint)
        self.joints = tuple(self.joint(name, 'wheel hinge') for name in names)
        if len(set(names)) < len(names):
            raise PluginError(f'{self.log_prefix}two of its joints are one: {", ".join(names)}')
        self._steering, self._driven, *encoders = self.joints
        self._encoders = Encoders(*encoders, config.encoder_diameter, config.encoder_separation)

    @property
    def every_step(self) -> bool:
        """Tell whether encoders are to be read."""
        return self.config.odometry_source == ENCODER

    def restart(self) -> None:
        """Forget everything and let the motors hold the steered wheel."""
        self.command(0.0, 0.0)
        self.reset()
        for joint in (self._steering, self._driven):
            joint.set_motor(0.0, self.config.torque)

    def reset(self) -> None:
        """Forget the command and where the encoders say that the robot is."""
        self._encoders.reset(self.world.clock.now_ns)
        super().reset()

    def sample(self, now_ns: int) -> None:
        """Read the encoders, of which upstream's takes the left one for the right one."""
        self._encoders.advance(now_ns, turning=-1.0)

    def follow(self, elapsed: float) -> None:
        """Drive and steer."""
        rim, _, angle = self.target
        self._drive(rim / (self.config.driven_diameter / 2.0), elapsed)
        self._steer(max(-STRAIGHT_ACROSS, min(STRAIGHT_ACROSS, angle)))

    def _drive(self, target: float, elapsed: float) -> None:
        """Bring the driven wheel nearer to a speed [rad/s]."""
        config, speed = self.config, self._driven.velocity
        missing = target - speed
        if config.acceleration > 0.0:
            limit = (config.deceleration if missing > 0.0 else config.acceleration) * elapsed
            if abs(missing) < config.speed_tolerance:
                target = speed
            elif abs(missing) > config.acceleration * elapsed:
                target = speed + math.copysign(limit, missing)
        self._driven.set_motor(target, config.torque)

    def _steer(self, target: float) -> None:
        """Turn the steering towards an angle [rad]."""
        config, missing = self.config, target - self._steering.position
        if config.steering_speed <= 0.0:
            self._steering.set_position(target)
            return
        turning = math.copysign(config.steering_speed, missing)
        if abs(missing) < config.angle_tolerance:
            turning = 0.0
        self._steering.set_motor(turning, config.torque)

    def report(self) -> None:
        """Tell odometry, joint transforms and joint states."""
        config = self.config
        pose, twist = self.model.state()
        if self.odometry.wanted():
            encoder = config.odometry_source == ENCODER
            self.odometry.send(self._encoder_odometry() if encoder else world_odometry(pose, twist))
        if config.publish_wheel_tf and self.wheel_transform.wanted():
            transforms = wheel_transforms(self.model, self.joints, pose)
            for joint, (parent, _, pose_in_model) in zip(self.joints, transforms, strict=True):
                self.wheel_transform.send(FrameTransform(parent, joint.name, pose_in_model))
        if config.publish_wheel_joint_state and self.joint_states.wanted():
            states = [joint.state() for joint in self.joints]
            positions, velocities = (tuple(values) for values in zip(*states, strict=True))
            names = tuple(joint.name for joint in self.joints)
            # Upstream reads the force that a user set, which is none.
            self.joint_states.send(JointStates(names, positions, velocities, (0.0,) * len(names)))

    def _encoder_odometry(self) -> Odometry:
        vx, vy, yaw_rate = self._encoders.rate
        return Odometry(self._encoders.pose, Twist((vx, vy, 0.0), (0.0, 0.0, yaw_rate)))


def _length(params: Params, tag: str, default: float) -> float:
    return above_zero(params, tag, params.read(tag, default))
