"""Odometry of drives: true, or by dead reckoning from the rotation of the wheels."""

import math
from typing import TYPE_CHECKING

from ...core import NANOSECONDS, Pose, Twist, from_rpy, yaw_of
from ...runtime import Odometry

if TYPE_CHECKING:
    from ...runtime import Joint


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
        self,
        left: 'Joint',
        right: 'Joint',
        diameter: float,
        separation: float,
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
