"""Base classes of the drives: velocity command, frames and outputs."""

import math
from abc import abstractmethod
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from ...core import Fault, Pose, compose, inverse, report
from ...runtime import FrameTransform, JointStates, Odometry, Output
from ..base import PeriodicPlugin
from ..parameters import Params
from .odometry import Encoders, world_odometry

if TYPE_CHECKING:
    from ...runtime import Joint

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
    topic_names: Mapping[str, str] = {'command': '<commandTopic>', 'odometry': '<odometryTopic>'}
    hints: Mapping[str, str] = {'torque': ' (the motor limit is <wheelTorque>)'}
    is_flat = False  # True: z is 0 in the reading of odometry, but not in the transform

    def read_frames(self, base: str) -> None:
        """Read the names of topics and frames; the robot's frame is `base` by default."""
        for tag, default in (
            ('commandTopic', 'cmd_vel'),
            ('odometryTopic', 'odom'),
            ('odometryFrame', 'odom'),
            ('robotBaseFrame', base),
        ):
            self.params.read(tag, default)

    def add_odometry(self, message: bool = True, transform: bool = True) -> None:
        """Create the outputs of odometry and of its transform, if they are requested."""
        self.odometry: Output[Odometry] = self.output('odometry', message)
        self.odometry_transform: Output[FrameTransform] = self.output(
            'odometry_transform', transform
        )

    @property
    def odometry_wanted(self) -> bool:
        """Tell whether odometry has a reader in either form."""
        return self.odometry.wanted or self.odometry_transform.wanted

    def read_odometry(self) -> Odometry:
        """Return the odometry of the current state, independent of the rate."""
        return world_odometry(*self.model.state())

    def report(self) -> None:
        """Send odometry."""
        if self.odometry_wanted:
            self.send_odometry(self.read_odometry())

    def send_odometry(self, reading: Odometry) -> None:
        """Send odometry in both forms."""
        if self.odometry_transform.wanted:
            string = self.params.string
            self.odometry_transform.send(
                FrameTransform(string('odometryFrame'), string('robotBaseFrame'), reading.pose)
            )
        if self.odometry.wanted:
            if self.is_flat:
                (x, y, _), orientation = reading.pose
                reading = Odometry(Pose((x, y, 0.0), orientation), reading.twist)
            self.odometry.send(reading)

    def restart(self) -> None:
        """Reset the command, and start."""
        self.command(0.0, 0.0)
        super().restart()

    def command(self, linear_x: float, angular_z: float, linear_y: float = 0.0) -> None:
        """Set the velocity command, which holds until the next one, or until it expires.

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
                f'angular_z {angular_z}, linear_y {linear_y}'
            )
        self.target = (linear_x, linear_y, angular_z)
        self._commanded_ns = self.world.clock.now_ns


class WheeledDrive(Drive):
    """A drive that also outputs wheel states, and whose odometry may come from two encoders.

    A subclass sets `encoders` in `load`, and `every_step` if odometry comes from them.
    """

    absent_namespace = empty_namespace = '{}'
    topic_names: Mapping[str, str] = {**Drive.topic_names, 'joint_states': 'joint_states'}
    encoders: Encoders

    def add_wheels(self, transforms: bool, states: bool) -> None:
        """Create the outputs of the wheel transforms, one per wheel, and of the joint states."""
        self.wheel_transform: Output[FrameTransform] = self.output('wheel_transform', transforms)
        self.joint_states: Output[JointStates] = self.output('joint_states', states)

    def read_odometry(self) -> Odometry:
        """Return the odometry of the current state, independent of the rate."""
        return self.encoder_odometry() if self.every_step else super().read_odometry()

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
            joint.spec.parent, joint.spec.child, compose(inverse(model_pose), pose)
        )


def reads_encoders(params: Params) -> bool:
    """Tell by <odometrySource> whether odometry comes from encoders, not from the world."""
    # Upstream's warning shows the enumeration value of `world`.
    text = params.read('odometrySource', WORLD, shown='1').lower()
    if text not in (ENCODER, WORLD, '0', '1'):
        what = f"{params.prefix}<odometrySource> is '{text}', which is neither encoder nor world"
        report(Fault(f'{what}; default is world'))
    return text in (ENCODER, '0')
