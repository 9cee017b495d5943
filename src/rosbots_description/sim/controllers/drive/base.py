"""What the controllers of wheeled robots have in common: commands, limits, odometry, frames."""

import logging
import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, TypeVar

from ...core import Fault, Twist, report
from ...description import Cylinder, LinkSpec, Sphere
from ...runtime import FrameTransform, Odometry, Output
from ..controller import RUNNING, Controller, RateGate, nanoseconds, require_finite
from ..errors import ControllerError
from .odometry import PlanarOdometry
from .speed_limiter import SpeedLimiter

if TYPE_CHECKING:
    from ..hardware import JointHandle

_DIAGONAL = 6
_SHORTEST, _LONGEST = 1e-6, 1e6  # of lengths [m], and of factors on them
_AT_REST = (0.0, 0.0, 0.0)
T = TypeVar('T')


class DriveController(Controller):
    """Follows a velocity command while it is fresh, and reports odometry of the wheels.

    Outputs: odometry, odometry_transform, and limited_command if `publish_cmd`. A subclass finds
    its joints in `load_joints`, measures in `advance_odometry`, and sets them in `drive`.

    Attributes:
        enable_odom_tf: whether the transform is sent.
        pose_variances: diagonal of the covariance of the pose; `twist_variances` likewise.
    """

    topic_names: Mapping[str, str] = {
        'command': 'cmd_vel',
        'odometry': 'odom',
        'odometry_transform': '/tf',
        'limited_command': 'cmd_vel_out',
    }

    # Forward [m/s], yaw rate [rad/s] and to the left [m/s]: the command, and the last two of them
    # as limited.
    _command = _AT_REST
    _commanded_ns: int | None = None
    _last = (_AT_REST, _AT_REST)
    wanted = _AT_REST  # the command, unless it has expired

    def load(self) -> None:
        """Read the parameters; find the joints."""
        read = self.params.read
        self.load_geometry()
        self.set_publish_rate(read('publish_rate', 50.0))
        self.open_loop = read('open_loop', False)
        self.planar = PlanarOdometry(read('velocity_rolling_window_size', 10.0))
        self._timeout_ns = nanoseconds(read('cmd_vel_timeout', 0.5))
        read('allow_multiple_cmd_vel_publishers', True)
        read('base_frame_id', 'base_link')
        read('odom_frame_id', 'odom')
        self.enable_odom_tf = read('enable_odom_tf', True)
        self._limiters = tuple(
            SpeedLimiter.from_parameters(self.params.section(section))
            for section in ('linear/x', 'angular/z', 'linear/y')
        )
        self.pose_variances = self._variances('pose_covariance_diagonal')
        self.twist_variances = self._variances('twist_covariance_diagonal')
        self.odometry: Output[Odometry] = self.output('odometry')
        self.odometry_transform: Output[FrameTransform] = self.output('odometry_transform')
        self.limited_command: Output[Twist] | None = (
            self.output('limited_command') if read('publish_cmd', False) else None
        )
        self.load_joints()
        self._brake()

    def load_geometry(self) -> None:
        """Read the parameters of the wheels."""

    def load_joints(self) -> None:
        """Find the joints."""

    def advance_odometry(self, now_ns: int) -> None:
        """Add the motion of the wheels since the last update to `planar`."""

    def drive(self, linear_x: float, angular_z: float, linear_y: float) -> None:
        """Command the joints to follow a velocity."""

    def stand(self) -> None:
        """Command the wheels to stop."""

    def begin_measuring(self) -> None:
        """Measure the motion of the wheels from here on."""

    def set_publish_rate(self, rate: float) -> None:
        """Set the rate of odometry [Hz]; <= 0: none."""
        self._gate = RateGate(rate)
        if self.state == RUNNING:
            self._gate.restart(self.world.clock.now_ns)

    def command(self, linear_x: float, angular_z: float, linear_y: float = 0.0) -> None:
        """Set the velocity command, which expires after `cmd_vel_timeout`.

        Args:
            linear_x: forward [m/s].
            angular_z: yaw rate, counter-clockwise [rad/s].
            linear_y: to the left [m/s]; only some drives follow it.
        Raises:
            ValueError: a number is not finite.
            ControllerError: the controller does not run.
        """
        require_finite((linear_x, angular_z, linear_y))
        self.require_running()
        self._command = (float(linear_x), float(angular_z), float(linear_y))
        self._commanded_ns = self.world.clock.now_ns

    def starting(self, now_ns: int) -> None:
        """Stand still, and start to measure."""
        self._brake()
        self.stand()
        self._gate.restart(now_ns)
        self.planar.restart(now_ns)
        self.begin_measuring()

    def stopping(self, now_ns: int) -> None:
        """Stand still."""
        self._brake()
        self.stand()

    def time_reset(self, now_ns: int) -> None:
        """Start again."""
        self.starting(now_ns)

    def update(self, now_ns: int, period: float) -> None:
        """Measure, report, and drive."""
        if self.open_loop:
            forward, yaw_rate, left = self._last[0]
            self.planar.advance_open_loop(forward, yaw_rate, now_ns, left)
        else:
            self.advance_odometry(now_ns)
        if self._gate.opens(now_ns) and self.is_read:
            self.report(self.planar.reading)
        self.wanted = wanted = self._command if self.is_fresh(now_ns) else _AT_REST
        last, before = self._last
        x, z, y = (
            limiter.limit(speed, one, other, period)
            for limiter, speed, one, other in zip(self._limiters, wanted, last, before, strict=True)
        )
        self._last = ((x, z, y), last)
        if self.limited_command is not None and self.limited_command.wanted:
            self.limited_command.send(Twist((x, y, 0.0), (0.0, 0.0, z)))
        self.drive(x, z, y)

    def is_fresh(self, now_ns: int) -> bool:
        """Tell whether there is a command that has not expired."""
        return self._commanded_ns is not None and now_ns - self._commanded_ns <= self._timeout_ns

    def _brake(self) -> None:
        self._command, self._commanded_ns = _AT_REST, None
        self._last = (_AT_REST, _AT_REST)

    def report(self, reading: Odometry) -> None:
        """Send what has readers."""
        if self.odometry.wanted:
            self.odometry.send(reading)
        if self.odometry_transform.wanted and self.enable_odom_tf:
            values = self.params.values
            self.odometry_transform.send(
                FrameTransform(
                    str(values['odom_frame_id']), str(values['base_frame_id']), reading.pose
                )
            )

    def _variances(self, path: str) -> tuple[float, ...]:
        """Return six variances; zeros, with an error, if the parameter has no such list."""
        given = self.params.find(path)
        if (
            isinstance(given, list | tuple)
            and len(given) == _DIAGONAL
            and all(isinstance(one, int | float) for one in given)
        ):
            return tuple(map(float, given))
        what = f"Controller '{self.name}': {path} must list six numbers; zeros are used"
        report(Fault(what, logging.ERROR))
        return (0.0,) * _DIAGONAL

    def wheel_names(self, path: str) -> list[str]:
        """Return the joints of a parameter that is a text or a list of texts.

        Raises:
            ControllerError: it is anything else.
        """
        given = self.params.find(path)
        if given is None:
            raise ControllerError(f"Couldn't retrieve wheel param '{path}'.")
        if isinstance(given, str):
            return [given]
        if not isinstance(given, list | tuple):
            raise ControllerError(
                f"Wheel param '{path}' is neither a list of strings nor a string."
            )
        if not given:
            raise ControllerError(f"Wheel param '{path}' is an empty list")
        for number, one in enumerate(given):
            if not isinstance(one, str):
                raise ControllerError(f"Wheel param '{path}' #{number} isn't a string.")
        return list(given)

    def length(self, path: str, find: Callable[[], float]) -> float:
        """Return a length [m]; if it is not given, what `find` returns.

        Raises:
            ControllerError: it is zero, negative or absurd.
        """
        given = self.params.number(path)
        value = find() if given is None else given
        if not _SHORTEST < value < _LONGEST:
            raise ControllerError(
                f'{path} is {value:g} m; it must be above 0'
                if value < _LONGEST
                else f'{path} is {value:g} m; it must be below {_LONGEST:g}'
            )
        return value

    def multiplier(self, path: str, default: float = 1.0) -> float:
        """Return a factor on a length.

        Raises:
            ControllerError: it is zero, negative or absurd.
        """
        value = self.params.read(path, default)
        if not _SHORTEST < value < _LONGEST:
            raise ControllerError(f'{path} is {value:g}; it must be above 0, and about 1')
        return value

    def wheel_radius(self, name: str) -> float:
        """Return the radius of a wheel's first collision [m].

        Raises:
            ControllerError: the wheel does not exist, or is neither a cylinder nor a sphere.
        """
        link = self._wheel_link(name)
        failed = f"Couldn't retrieve {name} wheel radius"
        if not link.collisions:
            raise ControllerError(
                f'Link {link.name} does not have collision description. Add collision description '
                'for link to urdf.',
                failed,
            )
        geometry = link.collisions[0].geometry
        if not isinstance(geometry, Cylinder | Sphere):
            raise ControllerError(
                f'Wheel link {link.name} is NOT modeled as a cylinder or sphere!', failed
            )
        return geometry.radius

    def joint_distance(self, one: str, other: str) -> float:
        """Return the horizontal distance of two joints, with all joints at zero [m].

        Raises:
            ControllerError: the model does not have one of them.
        """
        ends = (self._wheel_link(name).pose.position for name in (one, other))
        return math.dist(*(place[:2] for place in ends))

    def distance(self, one: str, other: str) -> float:
        """Return the distance of the origins of two joints in their parents [m].

        Raises:
            ControllerError: the URDF does not have one of them.
        """
        joints = self.robot.control.joints
        return math.dist(*(_described(joints, name).origin for name in (one, other)))

    def _wheel_link(self, name: str) -> LinkSpec:
        """Return the child link of a joint of the model."""
        return self.model.links[_described(self.model.joints, name).spec.child].spec


def _described(joints: Mapping[str, T], name: str) -> T:
    """Return a joint by its name.

    Raises:
        ControllerError: there is none.
    """
    if name not in joints:
        raise ControllerError(f"{name} couldn't be retrieved from model description")
    return joints[name]


def set_commands(joints: 'tuple[JointHandle, ...]', value: float) -> None:
    """Give some joints the same command."""
    for joint in joints:
        joint.command = value
