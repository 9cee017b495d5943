"""The skid steer drive: four wheel joints follow a planar velocity by slipping sideways.

Behaviour, defaults and timing are those of libgazebo_ros_skid_steer_drive.so in gazebo_ros_pkgs
2.9.2. It has no reset of its own upstream, so that a reset leaves the command as it is.
"""

from dataclasses import dataclass

from .drive import Drive, DriveConfig, above_zero, as_rate, world_odometry
from .params import Params, says_defaults_to
from .registry import register

JOINTS = ('leftFront', 'rightFront', 'leftRear', 'rightRear')


@dataclass(frozen=True)
class SkidSteerConfig(DriveConfig):
    """The plugin's tags, read and checked."""

    joints: tuple[str, str, str, str]  # left front, right front, left rear, right rear
    wheel_separation: float  # [m]
    wheel_diameter: float  # [m]
    torque: float  # [N m] per wheel
    broadcast_tf: bool
    variances: tuple[float, ...]  # of x, y [m^2] and yaw [rad^2], among those of six


@register('libgazebo_ros_skid_steer_drive.so')
class SkidSteerDrive(Drive):
    """Drive the wheels of each side alike; report where the robot truly is.

    Output: the port `odometry`. `wheels` are the joints in the order of `JOINTS`.
    """

    prefix = 'GazeboRosSkidSteerDrive Plugin (ns = {}/) '
    missing = staticmethod(says_defaults_to)
    named_after_model = False
    flat_odometry = True

    def read_config(self, params: Params) -> SkidSteerConfig:
        """Read all tags with upstream's defaults and in upstream's order."""
        read = params.read
        broadcast_tf = read('broadcastTF', False)
        joints = tuple(
            read(f'{joint}Joint', f'{side}_{end}_joint')
            for joint, (side, end) in zip(
                JOINTS,
                (('left', 'front'), ('right', 'front'), ('left', 'rear'), ('right', 'rear')),
                strict=True,
            )
        )
        return SkidSteerConfig(
            broadcast_tf=broadcast_tf,
            joints=joints,
            wheel_separation=above_zero(params, 'wheelSeparation', read('wheelSeparation', 0.4)),
            wheel_diameter=above_zero(params, 'wheelDiameter', read('wheelDiameter', 0.15)),
            torque=read('torque', 5.0),
            command_topic=read('commandTopic', 'cmd_vel'),
            odometry_topic=read('odometryTopic', 'odom'),
            odometry_frame=read('odometryFrame', 'odom'),
            robot_base_frame=read('robotBaseFrame', 'base_footprint'),
            update_rate=as_rate(params, 'updateRate', read('updateRate', 100.0)),
            variances=(
                read('covariance_x', 0.0001), read('covariance_y', 0.0001), 1e12, 1e12, 1e12,
                read('covariance_yaw', 0.01),
            ),
        )  # fmt: skip

    def find_joints(self) -> None:
        """Find the four wheels.

        Raises:
            PluginError: one of them is missing.
        """
        self.wheels = [
            self.joint(name, f'{what} hinge')
            for what, name in zip(JOINTS, self.config.joints, strict=True)
        ]

    @property
    def pose_variances(self) -> tuple[float, ...]:
        """Return the diagonal of the covariance of the pose."""
        return self.config.variances

    twist_variances = pose_variances

    @property
    def sends_transform(self) -> bool:
        """Tell whether the odometry transform is published, too."""
        return self.config.broadcast_tf

    def restart(self) -> None:
        """Forget the command and let the motors hold the wheels."""
        self.target = (0.0, 0.0, 0.0)
        self.follow()
        self.reset()

    def reset(self) -> None:
        """Begin a period anew; the command stays."""
        target = self.target
        super().reset()
        self.target = target

    def report(self) -> None:
        """Tell where the robot is."""
        if self.odometry.wanted():
            self.odometry.send(world_odometry(*self.model.state()))

    def follow(self, _elapsed: float = 0.0) -> None:
        """Set the wheels' speeds."""
        x, _, yaw_rate = self.target
        half = yaw_rate * self.config.wheel_separation / 2.0
        radius = self.config.wheel_diameter / 2.0
        for wheel, rim in zip(self.wheels, (x - half, x + half) * 2, strict=True):
            wheel.set_motor(rim / radius, self.config.torque)
