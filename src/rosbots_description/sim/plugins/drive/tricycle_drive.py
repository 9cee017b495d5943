"""The tricycle drive: one steered and driven wheel, and two encoder wheels.

Behaviour, defaults and timing are those of libgazebo_ros_tricycle_drive.so in gazebo_ros_pkgs
2.9.2, including its oddities: `linear.x` is the rim speed of the driven wheel and `angular.z` the
steering angle; `wheelDeceleration` limits speeding up and `wheelAcceleration` slowing down, both
in rad/s^2; the yaw of encoder odometry has the wrong sign, and its twist is in the odometry frame.
Different on purpose: it always steers towards the target angle; upstream steers away while it
drives forward and the angle is to decrease. Upstream has no reset of its own, so a reset of the
world keeps the command and the odometry.
"""

import math
from collections.abc import Iterable

from ...core import PluginError, Pose, Twist
from ...plugin_registry import register
from ...runtime import FrameTransform, JointStates, Odometry
from .base import WheeledDrive, reads_encoders
from .odometry import Encoders

STRAIGHT_ACROSS = math.pi / 2.0  # [rad] to which steering is limited


@register('libgazebo_ros_tricycle_drive.so')
class TricycleDrive(WheeledDrive):
    """Steer and drive one wheel; report odometry.

    Outputs: `odometry`, `odometry_transform`, `wheel_transform` (once per joint) and
    `joint_states`: steering, driven, left, right. `joints` are in that order.
    """

    prefix = 'TricycleDrive(ns = {}/): '

    def load(self) -> None:
        """Read all tags with upstream's defaults; find the joints."""
        params, read = self.params, self.params.read
        # [rad/s^2] of the driven wheel for slowing down and for speeding up; 0: no limit
        self.acceleration = read('wheelAcceleration', 0.0)
        read('rosDebugLevel', 'na')  # the log level of the server
        self.read_frames('base_link')
        self.add_odometry()
        self.set_rate(params.rate('updateRate', 100.0))
        names = (
            read('steeringJoint', 'front_steering_joint'),
            read('actuatedWheelJoint', 'front_wheel_joint'),
            read('encoderWheelLeftJoint', 'left_wheel_joint'),
            read('encoderWheelRightJoint', 'right_wheel_joint'),
        )
        self.driven_diameter = params.length('actuatedWheelDiameter', 0.15)  # [m]
        encoder_diameter = params.length('encoderWheelDiameter', 0.15)  # [m]
        encoder_separation = params.length('encoderWheelSeparation', 0.5)  # [m]
        self.torque = read('wheelTorque', 5.0)  # [N m] of the driven wheel and of steering
        self.deceleration = read('wheelDeceleration', self.acceleration)
        # [rad/s] tolerance within which the wheel keeps its speed
        self.speed_tolerance = read('wheelSpeedTolerance', 0.01)
        self.steering_speed = read('steeringSpeed', 0.0)  # [rad/s]; <= 0: at once
        self.angle_tolerance = read('steeringAngleTolerance', 0.01)  # [rad] to stop within
        self.every_step = reads_encoders(params)
        wheel_transforms = read('publishWheelTF', False)
        self.add_wheels(wheel_transforms, read('publishWheelJointState', False))
        self.joints = tuple(self.joint(name, 'wheel hinge') for name in names)
        if len(set(names)) < len(names):
            raise PluginError(f'{self.log_prefix}two of its joints are one: {", ".join(names)}')
        self._steering, self._driven, left, right = self.joints
        # Upstream swaps left and right.
        self.encoders = Encoders(left, right, encoder_diameter, encoder_separation, turning=-1.0)

    def restart(self) -> None:
        """Reset everything, and let the motors hold the steered wheel."""
        self.encoders.reset(self.world.clock.now_ns)
        super().restart()
        for joint in (self._steering, self._driven):
            joint.set_motor(0.0, self.torque)

    def update(self, elapsed: float) -> None:
        """Drive and steer."""
        rim, _, angle = self.target
        self._drive(rim / (self.driven_diameter / 2.0), elapsed)
        self._steer(max(-STRAIGHT_ACROSS, min(STRAIGHT_ACROSS, angle)))

    def _drive(self, target: float, elapsed: float) -> None:
        """Accelerate the driven wheel towards a speed [rad/s]."""
        speed = self._driven.velocity
        missing = target - speed
        if self.acceleration > 0.0:
            limit = (self.deceleration if missing > 0.0 else self.acceleration) * elapsed
            if abs(missing) < self.speed_tolerance:
                target = speed
            elif abs(missing) > self.acceleration * elapsed:
                target = speed + math.copysign(limit, missing)
        self._driven.set_motor(target, self.torque)

    def _steer(self, target: float) -> None:
        """Steer towards an angle [rad]."""
        missing = target - self._steering.position
        if self.steering_speed <= 0.0:
            self._steering.set_position(target)
            return
        turning = math.copysign(self.steering_speed, missing)
        if abs(missing) < self.angle_tolerance:
            turning = 0.0
        self._steering.set_motor(turning, self.torque)

    def encoder_odometry(self) -> Odometry:
        """Return the encoder odometry; as upstream, the twist is in the odometry frame."""
        vx, vy, yaw_rate = self.encoders.rate
        return Odometry(self.encoders.pose, Twist((vx, vy, 0.0), (0.0, 0.0, yaw_rate)))

    def wheel_transforms(self, model_pose: Pose) -> Iterable[FrameTransform]:
        """Return the transforms of the joints' child links, under the names of the joints."""
        return (self.in_model(one, model_pose)._replace(child=one.name) for one in self.joints)

    def wheel_states(self) -> JointStates:
        """Return the states of all joints."""
        positions, velocities = zip(*(joint.state() for joint in self.joints), strict=True)
        names = tuple(joint.name for joint in self.joints)
        # Upstream reads the effort that a user set, which is always 0.
        return JointStates(names, positions, velocities, (0.0,) * len(names))
