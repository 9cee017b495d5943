"""The steered car as a bicycle: one driven wheel behind, one steered joint in front.

Parameters, defaults and timing are those of ackermann_steering_controller 0.22, and of
steer_drive_controller, its former name. As upstream, `angular_z` is the angle of the steering.
"""

import math

from ..hardware import POSITION, VELOCITY, JointHandle
from ..registry import register_controller
from .base import DriveController


@register_controller('ackermann_steering_controller/AckermannSteeringController', VELOCITY)
@register_controller('steer_drive_controller/SteerDriveController', VELOCITY)
class AckermannSteeringController(DriveController):
    """Drive one wheel, and set the position of one steering joint."""

    def load_geometry(self) -> None:
        """Read names and sizes; what is not given is that of the URDF."""
        read = self.params.read
        self._names = (
            read('rear_wheel', 'rear_wheel_joint'),
            read('front_steer', 'front_steer_joint'),
        )
        wheelbase = self.length('wheel_separation_h', lambda: self.distance(*self._names))
        # As upstream, the multipliers act on odometry only.
        self._wheelbase = wheelbase * self.multiplier('wheel_separation_h_multiplier')
        self.radius = self.length('wheel_radius', lambda: self.wheel_radius(self._names[0]))
        self._odometry_radius = self.radius * self.multiplier('wheel_radius_multiplier')
        self._steering_scale = read('steer_pos_multiplier', 1.0)

    def load_joints(self) -> None:
        """Find the joints."""
        self.wheel: JointHandle = self.joint(self._names[0])
        self.steering: JointHandle = self.joint(self._names[1], POSITION)
        self.begin_measuring()

    def begin_measuring(self) -> None:
        """Measure the rotation of the wheel from here on."""
        self._way = self.wheel.position * self._odometry_radius

    def advance_odometry(self, now_ns: int) -> None:
        """Add the rotation of the wheel, along the arc of the steering angle."""
        before, self._way = self._way, self.wheel.position * self._odometry_radius
        forward = self._way - before
        angle = self.steering.position * self._steering_scale
        self.planar.advance(forward, math.tan(angle) * forward / self._wheelbase, now_ns)

    def drive(self, linear_x: float, angular_z: float, linear_y: float) -> None:
        """Set the wheel's speed, and the steering angle [rad]."""
        self.wheel.command = linear_x / self.radius
        self.steering.command = angular_z

    def stand(self) -> None:
        """Stop the wheel, and steer straight ahead."""
        self.wheel.command = self.steering.command = 0.0
