"""A car with four driven wheels, each on a steering joint.

Parameters, defaults and timing are those of four_wheel_steering_controller 0.22: a velocity steers
front and rear by opposite angles; the newest command counts, of a velocity or of speed and angles.
Odometry is the motion that fits the four wheels best, by the same kinematics.
"""

import math
from collections.abc import Mapping
from typing import NamedTuple

from ...core import NANOSECONDS
from ...runtime import Odometry, Output
from ..controller import require_finite
from ..errors import ControllerError
from ..hardware import POSITION, VELOCITY, JointHandle
from ..registry import register_controller
from .base import DriveController, set_commands

_SLOW = 0.001  # [m/s] below which the wheels stand
_ACROSS = math.pi / 2.0
_SMALL_ANGLE = 0.001  # [rad]


class FourWheelSteering(NamedTuple):
    """Speed [m/s] along the path, and the angles of the axles [rad], positive to the left."""

    speed: float
    front_angle: float
    rear_angle: float


@register_controller('four_wheel_steering_controller/FourWheelSteeringController', VELOCITY)
class FourWheelSteeringController(DriveController):
    """Drive and steer four wheels; the joints of each parameter are left and right."""

    topic_names: Mapping[str, str] = {
        **DriveController.topic_names,
        'steer': 'cmd_four_wheel_steering',
        'steering': 'odom_steer',
    }
    _steering: FourWheelSteering | None = None
    _measured_ns = 0

    def load_geometry(self) -> None:
        """Read names and sizes; what is not given is that of the URDF."""
        self._names = {
            path: self.wheel_names(path)
            for path in ('front_wheel', 'rear_wheel', 'front_steering', 'rear_steering')
        }
        for what, front, rear, one, two in (
            ('wheels', 'front_wheel', 'rear_wheel', 'front wheels', 'rear wheels'),
            ('steering', 'front_steering', 'rear_steering', 'left steerings', 'right steerings'),
        ):
            count, other = len(self._names[front]), len(self._names[rear])
            if count != other:
                raise ControllerError(f'#{one} ({count}) != #{two} ({other}).')
            if count != 2:
                raise ControllerError(
                    f'#two {what} by axle (left and right) is needed; now : {count} .'
                )
        left, right = self._names['front_wheel']
        self.track = self.length('track', lambda: self.joint_distance(left, right))
        self.wheel_base = self.length(
            'wheel_base', lambda: self.joint_distance(left, self._names['rear_wheel'][0])
        )
        self.radius = self.length('wheel_radius', lambda: self.wheel_radius(left))
        # Between the axis of steering and the middle of the wheel.
        self._offset = self.joint_distance(self._names['front_steering'][0], left)
        self._steering_track = self.track - 2.0 * self._offset

    def load_joints(self) -> None:
        """Find the joints."""
        self.wheels: tuple[JointHandle, ...] = tuple(
            self.joint(name) for path in ('front_wheel', 'rear_wheel') for name in self._names[path]
        )
        self.steerings: tuple[JointHandle, ...] = tuple(
            self.joint(name, POSITION)
            for path in ('front_steering', 'rear_steering')
            for name in self._names[path]
        )
        self.steering: Output[FourWheelSteering] = self.output('steering')

    def command(self, linear_x: float, angular_z: float, linear_y: float = 0.0) -> None:
        """Set the velocity command [m/s, rad/s]; see `DriveController.command`."""
        super().command(linear_x, angular_z, linear_y)
        self._steering = None

    def steer(self, speed: float, front_angle: float, rear_angle: float) -> None:
        """Set a speed [m/s] and the angles of both axles [rad] in place of a velocity.

        Raises:
            ValueError: a number is not finite.
            ControllerError: the controller does not run.
        """
        require_finite((front_angle, rear_angle))
        super().command(speed, 0.0)
        self._steering = FourWheelSteering(
            speed, *(max(-_ACROSS, min(_ACROSS, angle)) for angle in (front_angle, rear_angle))
        )

    def drive(self, linear_x: float, angular_z: float, linear_y: float) -> None:
        """Set speeds and angles."""
        if self._steering is None:
            angles = self._angles_of_velocity(linear_x, angular_z)
            speeds = self._speeds(linear_x, angular_z, (self.wheel_base / 2.0,) * 2)
        else:
            fresh = self.is_fresh(self.world.clock.now_ns)  # else straight ahead
            front, rear = (math.tan(angle) if fresh else 0.0 for angle in self._steering[1:])
            angles = self._angles_of_axles(front, rear)
            turn = front - rear
            lengths = (
                (0.0, 0.0)
                if abs(turn) < 1e-9
                else (self.wheel_base * abs(front / turn), self.wheel_base * abs(rear / turn))
            )
            speeds = self._speeds(linear_x, linear_x * turn / self.wheel_base, lengths)
        for wheel, speed in zip(self.wheels, speeds, strict=True):
            wheel.command = speed
        for joint, angle in zip(self.steerings, angles, strict=True):
            joint.command = angle

    def _angles_of_velocity(self, speed: float, yaw_rate: float) -> tuple[float, ...]:
        """Return the angles, front left to rear right, for a velocity."""
        across = yaw_rate * self._steering_track
        if abs(2.0 * speed) > abs(across):
            left, right = (
                math.atan(yaw_rate * self.wheel_base / (2.0 * speed + side * across))
                for side in (-1.0, 1.0)
            )
        elif abs(speed) > _SLOW:
            left = right = math.copysign(_ACROSS, yaw_rate)
        else:
            left = right = 0.0
        return left, right, -left, -right

    def _angles_of_axles(self, front: float, rear: float) -> tuple[float, ...]:
        """Return the angles, front left to rear right, for the tangents of those of the axles."""
        base = self.wheel_base
        across = self._steering_track * (front - rear) / 2.0
        if abs(base - abs(across)) <= 0.001:
            return (0.0,) * 4
        return tuple(
            math.atan(base * tangent / (base + side * across))
            for tangent in (front, rear)
            for side in (-1.0, 1.0)
        )

    def _speeds(
        self, speed: float, yaw_rate: float, lengths: tuple[float, float]
    ) -> tuple[float, ...]:
        """Return the speeds of the wheels [rad/s], front left to rear right.

        Args:
            lengths: along the car, from the centre of rotation to each axle [m].
        """
        if abs(speed) <= _SLOW:
            return (0.0,) * 4
        return tuple(
            (
                math.copysign(
                    math.hypot(
                        speed + side * yaw_rate * self._steering_track / 2.0, length * yaw_rate
                    ),
                    speed,
                )
                + side * yaw_rate * self._offset
            )
            / self.radius
            for length in lengths
            for side in (-1.0, 1.0)
        )

    def advance_odometry(self, now_ns: int) -> None:
        """Add the motion of both axles."""
        front, rear = (
            _axle_angle(*(one.position for one in pair))
            for pair in (self.steerings[:2], self.steerings[2:])
        )
        # Curvature of the path that the middle of each axle follows.
        turn = (math.tan(front) - math.tan(rear)) / self.wheel_base
        velocities = [
            self._axle_speed([one.velocity for one in pair], angle, turn)
            for pair, angle in ((self.wheels[:2], front), (self.wheels[2:], rear))
        ]
        yaw_rate = (
            sum(
                speed * math.cos(angle) * turn
                for speed, angle in zip(velocities, (front, rear), strict=True)
            )
            / 2.0
        )
        along, left = (
            sum(speed * part(angle) for speed, angle in zip(velocities, (front, rear), strict=True))
            / 2.0
            for part in (math.cos, math.sin)
        )
        elapsed = (now_ns - self._measured_ns) / NANOSECONDS
        self._measured_ns = now_ns
        self.planar.advance(along * elapsed, yaw_rate * elapsed, now_ns, left * elapsed)
        self._axles = front, rear

    def report(self, reading: Odometry) -> None:
        """Send what has readers."""
        super().report(reading)
        if self.steering.wanted:
            forward, left, _ = self.planar.velocity
            self.steering.send(
                FourWheelSteering(math.copysign(math.hypot(forward, left), forward), *self._axles)
            )

    def _axle_speed(self, speeds: list[float], angle: float, turn: float) -> float:
        """Return the speed of the middle of an axle [m/s] by its two wheels [rad/s]."""
        left, right = speeds
        curvature = turn * math.cos(angle)  # yaw rate per speed of the middle
        half = self._steering_track / 2.0
        # Relative to the middle, the steered points move at these speeds.
        ways = [
            math.sqrt(
                max(
                    0.0,
                    1.0 + side * 2.0 * half * curvature * math.cos(angle) + (half * curvature) ** 2,
                )
            )
            + side * self._offset * curvature
            for side in (-1.0, 1.0)
        ]
        # Least squares of speed * way = radius * wheel speed.
        return (
            self.radius
            * sum(way * speed for way, speed in zip(ways, (left, right), strict=True))
            / max(1e-9, sum(way * way for way in ways))
        )

    def begin_measuring(self) -> None:
        """Measure from here on."""
        self._measured_ns = self.world.clock.now_ns
        self._axles = (0.0, 0.0)

    def stand(self) -> None:
        """Stop the wheels, and steer straight ahead."""
        set_commands((*self.wheels, *self.steerings), 0.0)
        self._steering = None


def _axle_angle(left: float, right: float) -> float:
    """Return the angle of an axle's middle, given those of its wheels [rad]."""
    if abs(left) <= _SMALL_ANGLE and abs(right) <= _SMALL_ANGLE:
        return 0.0
    one, other = math.tan(left), math.tan(right)
    total = one + other
    return math.atan(2.0 * one * other / total) if abs(total) > 1e-9 else 0.0
