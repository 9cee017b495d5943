"""Planar movement: the model takes on the velocity that it is told, without wheels.

Behaviour, defaults and timing are those of libgazebo_ros_planar_move.so in gazebo_ros_pkgs 2.9.2.
The velocity is set at the beginning of each step, and physics goes on from there: what touches the
ground loses mu g dt of it, and what hangs in the air sinks by g dt in each second. A reset leaves
the command as it is.
"""

import math
from dataclasses import dataclass

from ..clock import NANOSECONDS
from ..pose import Pose, Twist, yaw_of
from ..readings import Odometry
from .drive import Drive, DriveConfig, as_rate
from .params import Params, says_defaults_to
from .registry import register


@dataclass(frozen=True)
class PlanarMoveConfig(DriveConfig):
    """The plugin's tags, read and checked; `update_rate` is that of odometry."""

    command_timeout: float  # [s] after which a command is forgotten; below 0: never


@register('libgazebo_ros_planar_move.so')
class PlanarMove(Drive):
    """Set the velocity of all links at each step; report where the robot truly is.

    Output: the port `odometry`, whose twist is told from two poses.
    """

    prefix = 'PlanarMovePlugin (ns = {}) '
    missing = staticmethod(says_defaults_to)
    named_after_model = False
    keeps_rate = False
    every_step = True
    flat_odometry = True
    moves_sideways = True

    def read_config(self, params: Params) -> PlanarMoveConfig:
        """Read all tags with upstream's defaults and in upstream's order."""
        read = params.read
        return PlanarMoveConfig(
            command_topic=read('commandTopic', 'cmd_vel'),
            odometry_topic=read('odometryTopic', 'odom'),
            odometry_frame=read('odometryFrame', 'odom'),
            robot_base_frame=read('robotBaseFrame', 'base_footprint'),
            update_rate=as_rate(params, 'odometryRate', read('odometryRate', 20.0)),
            command_timeout=read('cmdTimeout', -1.0),
        )

    @property
    def sends_odometry(self) -> bool:
        """Tell whether there is odometry at all."""
        return self.config.update_rate > 0.0

    sends_transform = sends_odometry

    def restart(self) -> None:
        """Forget the command."""
        self.command(0.0, 0.0)
        self.reset()

    def reset(self) -> None:
        """Tell motion from where the model stands now; the command stays."""
        target = self.target
        super().reset()
        self.target = target
        self._told_ns, self._told = self._last_ns, self.model.pose

    def command(self, linear_x: float, angular_z: float, linear_y: float = 0.0) -> None:
        """Move so until told else, or until the command is too old."""
        super().command(linear_x, angular_z, linear_y)
        self._commanded_ns = self.world.clock.now_ns

    def advance(self, now_ns: int) -> None:
        """Set the velocity of the model."""
        timeout = self.config.command_timeout
        if 0.0 <= timeout < (now_ns - self._commanded_ns) / NANOSECONDS:
            self.target = (0.0, 0.0, 0.0)
        x, y, yaw_rate = self.target
        yaw = yaw_of(self.model.pose.orientation)
        cos, sin = math.cos(yaw), math.sin(yaw)
        linear = (x * cos - y * sin, y * cos + x * sin, 0.0)
        self.model.set_twist(Twist(linear, (0.0, 0.0, yaw_rate)))

    def follow(self, elapsed: float) -> None:
        """Do nothing: the velocity is set at each step, and the rate is that of odometry."""

    def report(self) -> None:
        """Tell where the robot is, and what it has moved by since it did so last."""
        if not (self.sends_odometry and self.odometry.wanted()):
            return
        pose, now_ns = self.model.pose, self.world.clock.now_ns
        elapsed = (now_ns - self._told_ns) / NANOSECONDS
        self.odometry.send(Odometry(pose, self._twist(pose, elapsed)))
        self._told_ns, self._told = now_ns, pose

    def _twist(self, pose: Pose, elapsed: float) -> Twist:
        yaw, turning = yaw_of(pose.orientation), self.target[2]
        dx, dy = (
            (now - then) / elapsed
            for now, then in zip(pose.position[:2], self._told.position[:2], strict=True)
        )
        if abs(turning) <= math.pi / elapsed:  # else it has turned by more than can be told
            turning = math.remainder(yaw - yaw_of(self._told.orientation), math.tau) / elapsed
        cos, sin = math.cos(yaw), math.sin(yaw)
        return Twist((cos * dx + sin * dy, cos * dy - sin * dx, 0.0), (0.0, 0.0, turning))
