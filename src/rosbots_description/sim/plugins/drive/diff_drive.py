"""The differential drive: two wheel joints follow a planar velocity command; odometry.

Behaviour, defaults and timing are those of libgazebo_ros_diff_drive.so in gazebo_ros_pkgs 2.9.2.
"""

import math
from collections.abc import Iterable

from ...core import Fault, Pose, Twist, report
from ...plugin_registry import register
from ...runtime import FrameTransform, JointStates, Odometry
from ..wheel_geometry import drives_towards_x, radius_of, same_direction, track_of
from .base import WheeledDrive, reads_encoders
from .odometry import Encoders

RAMP_REACHED = 0.01  # [m/s] distance of the rim speed from its target at which a ramp ends
DRAGGED = 0.015  # relative speed loss of a robot that drags a caster (doc/physics.md)
TOLERATED = 0.02  # relative deviation of a wheel from the description without a warning


@register('libgazebo_ros_diff_drive.so')
class DiffDrive(WheeledDrive):
    """Drive two wheel joints from a planar velocity command; report odometry.

    Outputs: `odometry`, `odometry_transform`, `wheel_transform` (once per wheel) and `joint_states`
    (right, left). `wheels` are the joints, left first.
    """

    prefix = 'DiffDrive(ns = {}/): '

    def load(self) -> None:
        """Read all tags with upstream's defaults and in upstream's order; find the wheels."""
        params, read = self.params, self.params.read
        read('rosDebugLevel', 'na')  # the log level of the server
        self.read_frames('base_footprint')
        # publishTf is for the odometry message and its transform, publishOdomTF for the latter.
        odometry = read('publishTf', True)
        wheel_transforms = read('publishWheelTF', False)
        self.add_odometry(odometry, read('publishOdomTF', True) and odometry)
        self.add_wheels(wheel_transforms, read('publishWheelJointState', False))
        self.wheel_separation = params.length('wheelSeparation', 0.34)  # [m]
        self.wheel_diameter = params.length('wheelDiameter', 0.15)  # [m]
        self.wheel_acceleration = read('wheelAcceleration', 0.0)  # [m/s^2] at the rim; 0: no limit
        self.wheel_torque = read('wheelTorque', 5.0)  # [N m] per wheel
        self.set_rate(params.rate('updateRate', 100.0))
        names = read('leftJoint', 'left_joint'), read('rightJoint', 'right_joint')
        self.every_step = reads_encoders(params)
        left, right = (self.joint(name, 'wheel hinge') for name in names)
        self.wheels = (left, right)
        self.encoders = Encoders(left, right, self.wheel_diameter, self.wheel_separation)
        self._warn_geometry()
        self._warn_sides()

    def restart(self) -> None:
        """Reset everything, the ramp too, and let the motors hold the wheels."""
        # Current rim speeds of the ramp [m/s], left and right. As upstream, the ramp is open loop:
        # the speeds are never corrected by those of the wheels.
        self._setpoint = [0.0, 0.0]
        super().restart()
        for wheel in self.wheels:
            wheel.set_motor(0.0, self.wheel_torque)

    def reset(self) -> None:
        """Reset the command and the encoder odometry, and start a period, as upstream."""
        self.command(0.0, 0.0)
        self.encoders.reset(self.world.clock.now_ns)
        self.begin_period()

    def update(self, elapsed: float) -> None:
        """Set the wheels' speeds."""
        x, _, yaw_rate = self.target
        half, radius = yaw_rate * self.wheel_separation / 2.0, self.wheel_diameter / 2.0
        left, right = self.wheels
        target = [x - half, x + half]
        limit = self.wheel_acceleration * elapsed
        if limit > 0.0:
            missing = target[0] - left.velocity * radius, target[1] - right.velocity * radius
            if min(abs(missing[0]), abs(missing[1])) >= RAMP_REACHED:
                for i in (0, 1):
                    self._setpoint[i] += max(-limit, min(limit, missing[i]))
                target = self._setpoint
        left.set_motor(target[0] / radius, self.wheel_torque)
        right.set_motor(target[1] / radius, self.wheel_torque)

    def encoder_odometry(self) -> Odometry:
        """Return the encoder odometry, by upstream's formula: the speed is never negative."""
        vx, vy, yaw_rate = self.encoders.rate
        speed = math.hypot(vx, vy)
        return Odometry(self.encoders.pose, Twist((speed, 0.0, 0.0), (0.0, 0.0, yaw_rate)))

    def wheel_transforms(self, model_pose: Pose) -> Iterable[FrameTransform]:
        """Return the transforms of the wheel links."""
        return (self.in_model(wheel, model_pose) for wheel in self.wheels)

    def wheel_states(self) -> JointStates:
        """Return the wheels' positions, right before left."""
        left, right = self.wheels
        return JointStates((right.name, left.name), (right.position, left.position))

    def _warn_geometry(self) -> None:
        """Warn if diameter or separation contradict the collision geometry."""
        left, right = self.wheels
        radius, track = radius_of(left), abs(track_of(left, right))
        if radius is None or radius_of(right) is None or not track:
            return
        forward = 2.0 * radius / self.wheel_diameter
        wide = self.wheel_separation / track
        turn = forward * wide
        if abs(forward - 1.0) > TOLERATED or abs(wide - 1.0) > TOLERATED:
            report(
                Fault(
                    f'{self.log_prefix}wheelDiameter {self.wheel_diameter:g} m and wheelSeparation '
                    f'{self.wheel_separation:g} m contradict the collision geometry '
                    f'({2.0 * radius:.3g} m and {track:.3g} m): expect the robot to drive at '
                    f'{forward:.2f} of the commanded speed and to turn at {turn:.2f} of the '
                    f'commanded rate, or at {forward * (1.0 - DRAGGED):.2f} and '
                    f'{turn * (1.0 - DRAGGED):.2f} if it drags a caster'
                )
            )

    def _warn_sides(self) -> None:
        """Warn if the robot will not follow its commands, in Gazebo as here."""
        left, right = self.wheels
        faults = []
        if not same_direction(left, right):
            faults.append('spin when asked to drive straight; give both joints the same axis')
        else:
            if track_of(left, right) < 0.0:
                faults.append(
                    f"turn right when asked to turn left, for '{left.name}' is on the right side; "
                    'swap <leftJoint> and <rightJoint>'
                )
            if not drives_towards_x(left):
                faults.append('drive backwards when asked to drive on; reverse the joint axes')
        if faults:
            report(Fault(f'{self.log_prefix}this robot will {". It will ".join(faults)}'))
