"""What all drives share: a velocity command, frames, odometry of the model's motion."""

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
    """Follows a velocity command and gives out odometry, as a reading and as a transform.

    A subclass calls `read_frames` and `give_odometry` in `load`, and follows `target` (x [m/s],
    y [m/s], yaw rate [rad/s]) in `update`.
    """

    # Diagonals of the covariances of odometry: x, y, z, roll, pitch, yaw.
    pose_variances: tuple[float, ...] = (1e-5, 1e-5, 1e12, 1e12, 1e12, 1e-3)
    twist_variances: tuple[float, ...] = NO_VARIANCES
    hints: Mapping[str, str] = {'torque': ' (the motor limit is <wheelTorque>)'}
    target = (0.0, 0.0, 0.0)

    def read_frames(self, base: str) -> None:
        """Read the names of topics and frames; that of the robot's is `base` by default."""
        for tag, default in (('commandTopic', 'cmd_vel'), ('odometryTopic', 'odom'),
                             ('odometryFrame', 'odom'), ('robotBaseFrame', base)):
            self.params.read(tag, default)

    def give_odometry(self, message: bool = True, transform: bool = True) -> None:
        """Give out odometry, and the transform between its frames, if they are asked for."""
        self.odometry: Output[Odometry] = self.output('odometry', message)
        self.odometry_transform: Output[FrameTransform] = self.output(
            'odometry_transform', transform)

    @property
    def odometry_wanted(self) -> bool:
        """Tell whether anybody reads odometry in one form or the other."""
        return self.odometry.wanted or self.odometry_transform.wanted

    def send_odometry(self, reading: Odometry, flat: bool = False) -> None:
        """Send odometry in both forms; `flat` if z is 0 in the reading, though not in the other."""
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
        """Forget the command and begin."""
        self.command(0.0, 0.0)
        super().restart()

    def reset(self) -> None:
        """Begin a period."""
        self.begin_period()

    def command(self, linear_x: float, angular_z: float, linear_y: float = 0.0) -> None:
        """Drive so until told else, as far as this drive can.

        Args:
            linear_x: forward [m/s].
            angular_z: turning left [rad/s].
            linear_y: to the left [m/s].
        Raises:
            ValueError: a number is not finite.
        """
        if not all(map(math.isfinite, (linear_x, angular_z, linear_y))):
            raise ValueError(
                f'a velocity command takes finite numbers; it got linear_x {linear_x}, '
                f'angular_z {angular_z}, linear_y {linear_y}')
        self.target = (linear_x, linear_y, angular_z)


class WheeledDrive(Drive):
    """A drive that tells of its wheels, too, and whose odometry may come from two encoders.

    A subclass sets `encoders` in `load`, and `every_step` if odometry comes from them.
    """

    absent_namespace = empty_namespace = '{}'
    encoders: 'Encoders'

    def read_debug_level(self) -> None:
        """Read the level at which the server is to log."""
        self.params.read('rosDebugLevel', 'na')

    def give_wheels(self, transforms: bool, states: bool) -> None:
        """Give out where the wheels stand, once per wheel, and their joints' states."""
        self.wheel_transform: Output[FrameTransform] = self.output('wheel_transform', transforms)
        self.joint_states: Output[JointStates] = self.output('joint_states', states)

    @abstractmethod
    def encoder_odometry(self) -> Odometry:
        """Return what the encoders tell."""

    @abstractmethod
    def wheel_transforms(self, model_pose: Pose) -> Iterable[FrameTransform]:
        """Return where the wheels stand, with the model at that pose."""

    @abstractmethod
    def wheel_states(self) -> JointStates:
        """Return the states of the wheels' joints."""

    def reset(self) -> None:
        """Forget the command and where the encoders say that the robot is."""
        self.command(0.0, 0.0)
        self.encoders.reset(self.world.clock.now_ns)
        super().reset()

    def after_each_step(self, now_ns: int) -> None:
        """Read the encoders."""
        self.encoders.advance(now_ns)

    def report(self) -> None:
        """Tell odometry, wheel transforms and joint states."""
        odometry, wheels = self.odometry_wanted, self.wheel_transform.wanted
        if odometry or wheels:
            pose, twist = self.model.state()  # once: the engine takes its time to tell
        if odometry:
            encoders = self.every_step
            self.send_odometry(self.encoder_odometry() if encoders else world_odometry(pose, twist))
        if wheels:
            for transform in self.wheel_transforms(pose):
                self.wheel_transform.send(transform)
        if self.joint_states.wanted:
            self.joint_states.send(self.wheel_states())

    def in_model(self, joint: 'Joint', model_pose: Pose) -> FrameTransform:
        """Return where the link on a joint stands in the model's frame, which is called parent."""
        pose = self.model.links[joint.spec.child].pose
        return FrameTransform(
            joint.spec.parent, joint.spec.child, compose(inverse(model_pose), pose))


def reads_encoders(params: Params) -> bool:
    """Tell by <odometrySource> whether odometry comes from encoders; else it is the truth."""
    # Upstream's warning shows the number behind `world`.
    text = params.read('odometrySource', WORLD, shown='1').lower()
    if text not in (ENCODER, WORLD, '0', '1'):
        logger.warning(
            "%s<odometrySource> is '%s', which is neither encoder nor world; default is world",
            params.prefix,
            text,
        )
    return text in (ENCODER, '0')


def world_odometry(pose: Pose, twist: Twist) -> Odometry:
    """Return the model's true pose, and its twist in the plane in the model's own axes."""
    (vx, vy, _), (_, _, yaw_rate) = twist
    yaw = yaw_of(pose.orientation)
    cos, sin = math.cos(yaw), math.sin(yaw)
    linear = (cos * vx + sin * vy, cos * vy - sin * vx, 0.0)
    return Odometry(pose, Twist(linear, (0.0, 0.0, yaw_rate)))


class Encoders:
    """Where two wheels say that a robot is, by the angles that they have turned through.

    Their angles are what joint states tell, so both agree.
    """

    def __init__(
        self, left: 'Joint', right: 'Joint', diameter: float, separation: float,
        turning: float = 1.0,
    ) -> None:
        """Take the wheels, and their diameter and separation [m]; `reset` begins.

        Args:
            turning: -1 where left counts as right.
        """
        self._wheels, self._radius, self._separation = (left, right), diameter / 2.0, separation
        self._turning = turning

    def reset(self, now_ns: int) -> None:
        """Begin anew at the origin."""
        self.place = (0.0, 0.0, 0.0)  # x [m], y [m], yaw [rad]
        self.rate = (0.0, 0.0, 0.0)  # of the same, by time
        self._ns, self._ways = now_ns, self._measure()

    def advance(self, now_ns: int) -> None:
        """Add what the wheels have turned."""
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
        """Return how far the rims have turned [m]."""
        return tuple(wheel.position * self._radius for wheel in self._wheels)

    @property
    def pose(self) -> Pose:
        """Return the place as a pose."""
        x, y, yaw = self.place
        return Pose((x, y, 0.0), from_rpy(0.0, 0.0, yaw))
