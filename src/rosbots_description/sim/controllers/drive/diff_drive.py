"""The differential drive: wheels on two sides follow a planar velocity command.

Parameters, defaults and timing are those of diff_drive_controller 0.22.
"""

import math
from collections.abc import Mapping, Sequence

from ...runtime import Output
from ..errors import ControllerError
from ..hardware import VELOCITY, JointHandle
from ..registry import register_controller
from ..trajectory import TrajectoryPoint, TrajectoryState
from .base import DriveController, set_commands


@register_controller('diff_drive_controller/DiffDriveController', VELOCITY)
class DiffDriveController(DriveController):
    """Drive the wheels of two sides.

    The multipliers of radius and separation may be set at any time. A further output, in each
    update, is wheel_joint_controller_state, if publish_wheel_joint_controller_state: the left
    wheels, then the right ones, and what the velocity before its limits would be.
    """

    topic_names: Mapping[str, str] = {
        **DriveController.topic_names,
        'wheel_states': 'wheel_joint_controller_state',
    }
    wheel_states: Output[TrajectoryState] | None = None

    def load_geometry(self) -> None:
        """Read names and sizes of the wheels; what is not given is that of the URDF."""
        read = self.params.read
        self._left_names, self._right_names = (
            self.wheel_names(path) for path in ('left_wheel', 'right_wheel')
        )
        left, right = len(self._left_names), len(self._right_names)
        if left != right:
            raise ControllerError(f'#left wheels ({left}) != #right wheels ({right}).')
        self.wheel_separation_multiplier = self.multiplier('wheel_separation_multiplier')
        paths = ['left_wheel_radius_multiplier', 'right_wheel_radius_multiplier']
        if self.params.number('wheel_radius_multiplier') is not None:
            paths = ['wheel_radius_multiplier'] * 2
        self.left_wheel_radius_multiplier, self.right_wheel_radius_multiplier = map(
            self.multiplier, paths
        )
        names = self._left_names[0], self._right_names[0]
        self._reports_wheels = read('publish_wheel_joint_controller_state', False)
        self.wheel_separation = self.length('wheel_separation', lambda: self.distance(*names))
        self.wheel_radius_given = self.length('wheel_radius', lambda: self.wheel_radius(names[0]))

    def load_joints(self) -> None:
        """Find the wheels."""
        self.left: tuple[JointHandle, ...] = tuple(map(self.joint, self._left_names))
        self.right: tuple[JointHandle, ...] = tuple(map(self.joint, self._right_names))
        self._wheels = self.left + self.right
        self._desired = [(0.0, 0.0)] * len(self._wheels)  # positions and velocities
        self._last_speeds = [0.0] * len(self._wheels)
        if self._reports_wheels:
            self.wheel_states = self.output('wheel_states')
        self.begin_measuring()

    def begin_measuring(self) -> None:
        """Measure the rotation of the wheels from here on."""
        self._ways = self._measure()

    def _measure(self) -> tuple[float, float]:
        """Return the mean distances of the rims [m], left and right."""
        left, right = (
            sum(one.position for one in side) / len(side) for side in (self.left, self.right)
        )
        return left * self._radii[0], right * self._radii[1]

    @property
    def _radii(self) -> tuple[float, float]:
        radius = self.wheel_radius_given
        return (
            radius * self.left_wheel_radius_multiplier,
            radius * self.right_wheel_radius_multiplier,
        )

    @property
    def _separation(self) -> float:
        return self.wheel_separation * self.wheel_separation_multiplier

    def advance_odometry(self, now_ns: int) -> None:
        """Add the rotation of the wheels."""
        before, self._ways = self._ways, self._measure()
        left, right = (now - then for now, then in zip(self._ways, before, strict=True))
        self.planar.advance((left + right) / 2.0, (right - left) / self._separation, now_ns)

    def drive(self, linear_x: float, angular_z: float, linear_y: float) -> None:
        """Set the wheels' speeds."""
        left, right = self._speeds(linear_x, angular_z)
        set_commands(self.left, left)
        set_commands(self.right, right)

    def _speeds(self, forward: float, yaw_rate: float) -> tuple[float, float]:
        """Return the speeds of the wheels for a velocity [rad/s], left and right."""
        half = yaw_rate * self._separation / 2.0
        left, right = self._radii
        return (forward - half) / left, (forward + half) / right

    def stand(self) -> None:
        """Stop the wheels."""
        set_commands(self._wheels, 0.0)

    def update(self, now_ns: int, period: float) -> None:
        """Also report the wheels."""
        super().update(now_ns, period)
        if self.wheel_states is not None:
            self._report_wheels(self.wheel_states, period)

    def _report_wheels(self, output: Output[TrajectoryState], period: float) -> None:
        """Send the state of the wheels; as upstream the desired acceleration is dv * dt."""
        left, right = self._speeds(*self.wanted[:2])
        speeds = [left] * len(self.left) + [right] * len(self.right)
        before = self._desired
        self._desired = [
            (position + speed * period, speed)
            for (position, _), speed in zip(before, speeds, strict=True)
        ]
        if output.wanted:
            output.send(self._wheel_state(before, period))
        self._last_speeds = [wheel.velocity for wheel in self._wheels]

    def _wheel_state(self, before: Sequence[tuple[float, float]], period: float) -> TrajectoryState:
        desired = [
            (position, speed, (speed - last) * period, math.nan)
            for (position, speed), (_, last) in zip(self._desired, before, strict=True)
        ]
        actual = [
            (wheel.position, wheel.velocity, (wheel.velocity - last) / period, wheel.effort)
            for wheel, last in zip(self._wheels, self._last_speeds, strict=True)
        ]
        errors = [
            (p - q, v - w, a - b, e - f)
            for (p, v, a, e), (q, w, b, f) in zip(desired, actual, strict=True)
        ]
        return TrajectoryState(
            tuple(wheel.name for wheel in self._wheels),
            _point(desired),
            _point(actual),
            _point(errors),
        )


def _point(rows: Sequence[tuple[float, float, float, float]]) -> TrajectoryPoint:
    """Return a point of some wheels: position, velocity, acceleration and effort of each."""
    positions, velocities, accelerations, efforts = zip(*rows, strict=True)
    return TrajectoryPoint(positions, velocities, accelerations, 0.0, efforts)
