"""Planar movement: the model moves at the commanded velocity, without wheels.

Behaviour, defaults and timing are those of libgazebo_ros_planar_move.so in gazebo_ros_pkgs 2.9.2.
The velocity is set at the beginning of each step, and physics changes it within the step: friction
takes mu g dt of a sliding model's speed, and a model in the air sinks at g dt. A reset keeps the
command.
"""

import math

from ...core import NANOSECONDS, Pose, Twist, yaw_of
from ...plugin_registry import register
from ...runtime import Odometry
from ..parameters import says_defaults_to
from .base import Drive


@register('libgazebo_ros_planar_move.so')
class PlanarMove(Drive):
    """Set the velocity of all links at each step; report the true pose.

    Outputs: `odometry`, with the twist as the difference of two poses, and `odometry_transform`.
    """

    prefix = 'PlanarMovePlugin (ns = {}) '
    missing = staticmethod(says_defaults_to)
    is_flat = True
    keeps_rate = False
    every_step = True

    def load(self) -> None:
        """Read all tags with upstream's defaults and in upstream's order."""
        self.read_frames('base_footprint')
        rate = self.params.rate('odometryRate', 20.0)  # 0 for none
        self.set_rate(rate)
        self.add_odometry(rate > 0.0, rate > 0.0)
        # [s] after which a command expires; below 0: never
        self.command_timeout = self.params.read('cmdTimeout', -1.0)

    def reset(self) -> None:
        """Measure the motion from the current pose on; keep the command."""
        self._measured_ns, self._measured = self.world.clock.now_ns, self.model.pose

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
        """Send the pose, and the mean twist since the last report."""
        if self.odometry_wanted:
            pose, now_ns = self.model.pose, self.world.clock.now_ns
            elapsed = (now_ns - self._measured_ns) / NANOSECONDS
            self.send_odometry(Odometry(pose, self._twist(pose, elapsed)))
            self._measured_ns, self._measured = now_ns, pose

    def _twist(self, pose: Pose, elapsed: float) -> Twist:
        yaw, turning = yaw_of(pose.orientation), self.target[2]
        dx, dy = (
            (now - then) / elapsed
            for now, then in zip(pose.position[:2], self._measured.position[:2], strict=True)
        )
        if abs(turning) <= math.pi / elapsed:  # else the rotation is ambiguous
            turning = math.remainder(yaw - yaw_of(self._measured.orientation), math.tau) / elapsed
        cos, sin = math.cos(yaw), math.sin(yaw)
        return Twist((cos * dx + sin * dy, cos * dy - sin * dx, 0.0), (0.0, 0.0, turning))
