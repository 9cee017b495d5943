"""Dead reckoning in the plane, from the distances that a robot has driven."""

import math
from collections import deque

from ...core import NANOSECONDS, Pose, Twist, from_rpy
from ...runtime import Odometry

_STRAIGHT = 1e-6  # [rad] rotation below which a step counts as straight
_LARGEST = 10_000  # steps in a mean
_SHORTEST = 1e-4  # [s] below which no velocity is estimated


class PlanarOdometry:
    """Pose by exact integration of arcs; velocity as a mean over the last steps."""

    def __init__(self, window: float) -> None:
        """Begin at the origin; `window` is the number of steps in the mean."""
        self._size = max(1, int(min(window, _LARGEST)))
        self.x = self.y = self.heading = 0.0
        self.restart(0)

    def restart(self, now_ns: int) -> None:
        """Begin to estimate velocities; the pose stays."""
        self._ns = now_ns
        self.velocity = (0.0, 0.0, 0.0)  # forward, left [m/s], yaw rate [rad/s]
        self._steps: deque[tuple[float, ...]] = deque(maxlen=self._size)

    def advance(self, forward: float, turn: float, now_ns: int, left: float = 0.0) -> None:
        """Add a step of `forward` and `left` [m] and `turn` [rad] in the robot's frame."""
        if not math.isfinite(forward + left + turn):
            return  # the model has diverged, and will be put back
        self._integrate(forward, left, turn)
        elapsed = (now_ns - self._ns) / NANOSECONDS
        if elapsed < _SHORTEST:
            return
        self._ns = now_ns
        self._steps.append((forward / elapsed, left / elapsed, turn / elapsed))
        vx, vy, yaw_rate = (sum(one) / len(self._steps) for one in zip(*self._steps, strict=True))
        self.velocity = (vx, vy, yaw_rate)

    def advance_open_loop(
        self, forward: float, yaw_rate: float, now_ns: int, left: float = 0.0
    ) -> None:
        """Add a step at commanded velocities [m/s, rad/s]."""
        elapsed = (now_ns - self._ns) / NANOSECONDS
        self._ns, self.velocity = now_ns, (forward, left, yaw_rate)
        self._integrate(forward * elapsed, left * elapsed, yaw_rate * elapsed)

    @property
    def reading(self) -> Odometry:
        """Return pose and velocity."""
        vx, vy, yaw_rate = self.velocity
        return Odometry(
            Pose((self.x, self.y, 0.0), from_rpy(0.0, 0.0, self.heading)),
            Twist((vx, vy, 0.0), (0.0, 0.0, yaw_rate)),
        )

    def _integrate(self, forward: float, left: float, turn: float) -> None:
        before = self.heading
        self.heading = after = before + turn
        if abs(turn) < _STRAIGHT:
            middle = before + turn / 2.0
            along, across = math.cos(middle), math.sin(middle)
        else:
            along = (math.sin(after) - math.sin(before)) / turn
            across = (math.cos(before) - math.cos(after)) / turn
        self.x += forward * along - left * across
        self.y += forward * across + left * along
