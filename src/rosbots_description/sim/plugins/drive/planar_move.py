"""Planar movement: the model takes on the velocity that it is told, without wheels.

Behaviour, defaults and timing are those of libgazebo_ros_planar_move.so in gazebo_ros_pkgs 2.9.2.
The velocity is set at the beginning of each step, and physics goes on from there: what touches the
ground loses mu g dt of it, and what hangs in the air sinks by g dt in each second. A reset leaves
the command as it is.
"""

import math

from ...core import NANOSECONDS, Pose, Twist, yaw_of
from ...plugin_registry import register
from ...runtime import Odometry
from ..parameters import says_defaults_to
from .base import Drive


@register('libgazebo_ros_planar_move.so')
class PlanarMove(Drive):
    """Set the velocity of all links at each step; report where the robot truly is.

    Outputs: `odometry`, whose twist is told from two poses, and `odometry_transform`.
    """

    prefix = 'PlanarMovePlugin (ns = {}) '
    missing = staticmethod(says_defaults_to)
    keeps_rate = False
    every_step = True

    def load(self) -> None:
        """Read all tags with upstream's defaults and in upstream's order."""
        self.read_frames('base_footprint')
        rate = self.params.rate('odometryRate', 20.0)  # 0 for none
        self.set_rate(rate)
        self.give_odometry(rate > 0.0, rate > 0.0)
        # [s] after which a command is forgotten; below 0: never
        self.command_timeout = self.params.read('cmdTimeout', -1.0)

    def reset(self) -> None:
        """Tell motion from where the model stands now; the command stays."""
        super().reset()
        self._told_ns, self._told = self.world.clock.now_ns, self.model.pose

    def command(self, linear_x: float, angular_z: float, linear_y: float = 0.0) -> None:
        """Move so until told else, or until the command is too old."""
        super().command(linear_x, angular_z, linear_y)
        self._commanded_ns = self.world.clock.now_ns

    def before_each_step(self, now_ns: int) -> None:
        """Set the velocity of the model."""
        if 0.0 <= self.command_timeout < (now_ns - self._commanded_ns) / NANOSECONDS:
            self.target = (0.0, 0.0, 0.0)
        x, y, yaw_rate = self.target
        yaw = yaw_of(self.model.pose.orientation)
        cos, sin = math.cos(yaw), math.sin(yaw)
        linear = (x * cos - y * sin, y * cos + x * sin, 0.0)
        self.model.set_twist(Twist(linear, (0.0, 0.0, yaw_rate)))

    def report(self) -> None:
        """Tell where the robot is, and what it has moved by since it did so last."""
        if self.odometry_wanted:
            pose, now_ns = self.model.pose, self.world.clock.now_ns
            elapsed = (now_ns - self._told_ns) / NANOSECONDS
            self.send_odometry(Odometry(pose, self._twist(pose, elapsed)), flat=True)
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
