"""Base classes of the drives: velocity command, frames and odometry."""

import logging
import math
from abc import abstractmethod
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from ...core import NANOSECONDS, Pose, Twist, compose, from_rpy, inverse, yaw_of
from ...runtime import FrameTransform, JointStates, Odometry, Output
from ..base import PeriodicPlugin
from ..parameters import Params

if TYPE_CHECKING:
    from ...runtime import Joint

logger = logging.getLogger(__name__)

ENCODER, WORLD = 'encoder', 'world'
NO_VARIANCES = (0.0,) * 6


class Drive(PeriodicPlugin):
    """Follows a velocity command and outputs odometry, as a reading and as a transform.

    A subclass calls `read_frames` and `add_odometry` in `load`, and follows `target` (x [m/s],
    y [m/s], yaw rate [rad/s]) in `update`.
    """

    # Diagonals of the covariances of odometry: x, y, z, roll, pitch, yaw.
    pose_variances: tuple[float, ...] = (1e-5, 1e-5, 1e12, 1e12, 1e12, 1e-3)
    twist_variances: tuple[float, ...] = NO_VARIANCES
    hints: Mapping[str, str] = {'torque': ' (the motor limit is <wheelTorque>)'}
    target = (0.0, 0.0, 0.0)

    def read_frames(self, base: str) -> None:
        """Read the names of topics and frames; the robot's frame is `base` by default."""
        for tag, default in (('commandTopic', 'cmd_vel'), ('odometryTopic', 'odom'),
                             ('odometryFrame', 'odom'), ('robotBaseFrame', base)):
            self.params.read(tag, default)

    def add_odometry(self, message: bool = True, transform: bool = True) -> None:
        """Create the outputs of odometry and of its transform, if they are requested."""
        self.odometry: Output[Odometry] = self.output('odometry', message)
        self.odometry_transform: Output[FrameTransform] = self.output(
            'odometry_transform', transform)

    @property
    def odometry_wanted(self) -> bool:
        """Tell whether odometry has a reader in either form."""
        return self.odometry.wanted or self.odometry_transform.wanted

    def send_odometry(self, reading: Odometry, flat: bool = False) -> None:
        """Send odometry in both forms; `flat`: z is 0 in the reading, but not in the transform."""
        if self.odometry_transform.wanted:
            string = self.params.string
            self.odometry_transform.send(
                FrameTransform(string('odometryFrame'), string('robotBaseFrame'), reading.pose))
        if self.odometry.wanted:
            if flat:
                (x, y, _), orientation = reading.pose
                reading = Odometry(Pose((x, y, 0.0), orientation), reading.twist)
            self.odometry.send(reading)

    def restart(self) -> None:
        """Reset the command, and start."""
        self.command(0.0, 0.0)
        super().restart()

    def command(self, linear_x: float, angular_z: float, linear_y: float = 0.0) -> None:
        """Set the velocity command, which holds until the next one.

        Args:
            linear_x: forward [m/s].
            angular_z: yaw rate, counter-clockwise [rad/s].
            linear_y: to the left [m/s]; only some drives follow it.
        Raises:
            ValueError: a number is not finite.
        """
        if not all(map(math.isfinite, (linear_x, angular_z, linear_y))):
            raise ValueError(
                f'a velocity command takes finite numbers; it got linear_x {linear_x}, '
                f'angular_z {angular_z}, linear_y {linear_y}')
        self.target = (linear_x, linear_y, angular_z)


class WheeledDrive(Drive):
    """A drive that also outputs wheel states, and whose odometry may come from two encoders.

    A subclass sets `encoders` in `load`, and `every_step` if odometry comes from them.
    """

    absent_namespace = empty_namespace = '{}'
    encoders: 'Encoders'

    def read_debug_level(self) -> None:
        """Read the log level of the server."""
        self.params.read('rosDebugLevel', 'na')

    def add_wheels(self, transforms: bool, states: bool) -> None:
        """Create the outputs of the wheel transforms, one per wheel, and of the joint states."""
        self.wheel_transform: Output[FrameTransform] = self.output('wheel_transform', transforms)
        self.joint_states: Output[JointStates] = self.output('joint_states', states)

    @abstractmethod
    def encoder_odometry(self) -> Odometry:
        """Return the odometry of the encoders."""

    @abstractmethod
    def wheel_transforms(self, model_pose: Pose) -> Iterable[FrameTransform]:
        """Return the transforms of the wheels, with the model at that pose."""

    @abstractmethod
    def wheel_states(self) -> JointStates:
        """Return the states of the wheels' joints."""

    def after_each_step(self, now_ns: int) -> None:
        """Read the encoders."""
        self.encoders.advance(now_ns)

    def report(self) -> None:
        """Send odometry, wheel transforms and joint states."""
        odometry, wheels = self.odometry_wanted, self.wheel_transform.wanted
        if odometry or wheels:
            pose, twist = self.model.state()  # read once: it is slow
        if odometry:
            encoders = self.every_step
            self.send_odometry(self.encoder_odometry() if encoders else world_odometry(pose, twist))
        if wheels:
            for transform in self.wheel_transforms(pose):
                self.wheel_transform.send(transform)
        if self.joint_states.wanted:
            self.joint_states.send(self.wheel_states())

    def in_model(self, joint: 'Joint', model_pose: Pose) -> FrameTransform:
        """Return the transform of a joint's child link in the model's frame, the parent."""
        pose = self.model.links[joint.spec.child].pose
        return FrameTransform(
            joint.spec.parent, joint.spec.child, compose(inverse(model_pose), pose))


def reads_encoders(params: Params) -> bool:
    """Tell by <odometrySource> whether odometry comes from encoders, not from the world."""
    # Upstream's warning shows the enumeration value of `world`.
    text = params.read('odometrySource', WORLD, shown='1').lower()
    if text not in (ENCODER, WORLD, '0', '1'):
        logger.warning(
            "%s<odometrySource> is '%s', which is neither encoder nor world; default is world",
            params.prefix,
            text,
        )
    return text in (ENCODER, '0')


def world_odometry(pose: Pose, twist: Twist) -> Odometry:
    """Return the model's true pose, and its planar twist in the model's axes."""
    (vx, vy, _), (_, _, yaw_rate) = twist
    yaw = yaw_of(pose.orientation)
    cos, sin = math.cos(yaw), math.sin(yaw)
    linear = (cos * vx + sin * vy, cos * vy - sin * vx, 0.0)
    return Odometry(pose, Twist(linear, (0.0, 0.0, yaw_rate)))


class Encoders:
    """Dead reckoning from the rotation of two wheels.

    It uses the positions of the joint states, so that both agree.
    """

    def __init__(
        self, left: 'Joint', right: 'Joint', diameter: float, separation: float,
        turning: float = 1.0,
    ) -> None:
        """Use these wheels of that diameter and separation [m]; call `reset` to start.

        Args:
            turning: -1 if left and right are swapped, as upstream.
        """
        self._wheels, self._radius, self._separation = (left, right), diameter / 2.0, separation
        self._turning = turning

    def reset(self, now_ns: int) -> None:
        """Start again at the origin."""
        self.place = (0.0, 0.0, 0.0)  # x [m], y [m], yaw [rad]
        self.rate = (0.0, 0.0, 0.0)  # its time derivative
        self._ns, self._ways = now_ns, self._measure()

    def advance(self, now_ns: int) -> None:
        """Integrate the rotation of the wheels."""
        elapsed, self._ns = (now_ns - self._ns) / NANOSECONDS, now_ns
        before, self._ways = self._ways, self._measure()
        if elapsed <= 0.0:
            return
        left, right = (now - then for now, then in zip(self._ways, before, strict=True))
        x, y, yaw = self.place
        turn = self._turning * (right - left) / self._separation
        forward, heading = (left + right) / 2.0, yaw + turn / 2.0
        dx, dy = forward * math.cos(heading), forward * math.sin(heading)
        self.place = (x + dx, y + dy, yaw + turn)
        self.rate = (dx / elapsed, dy / elapsed, turn / elapsed)

    def _measure(self) -> tuple[float, ...]:
        """Return the rim distances [m]."""
        return tuple(wheel.position * self._radius for wheel in self._wheels)

    @property
    def pose(self) -> Pose:
        """Return the current pose."""
        x, y, yaw = self.place
        return Pose((x, y, 0.0), from_rpy(0.0, 0.0, yaw))
