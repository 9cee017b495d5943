"""What a robot turns by though its tyres do not tell.

A tyre that rolls passes over as much ground as it turns. PyBullet's solver leaves a little of that
undone, of one wheel more than of the other, as it does with motors (wheel.py), and a robot that
drives straight on would turn by it.
"""

import math
from typing import TYPE_CHECKING

from .clock import NANOSECONDS, SimClock
from .pose import yaw_of
from .wheel import Wheel

if TYPE_CHECKING:
    from .model import Model

MOST = 0.0025  # [m/s] a wheel that is off by more slides, or something pushes the robot


class Drift:
    """Compares how a robot turns with what its tyres tell."""

    def __init__(self, model: 'Model', left: Wheel, right: Wheel, clock: SimClock) -> None:
        """Describe it; the first `look` is without effect."""
        self._model = model
        self._left, self._right = left, right
        self._clock = clock
        self._track = 0.0  # [m]
        if left.radius and right.radius:
            self._track = math.dist(left.touches_on_axle(), right.touches_on_axle())
        self.rest()

    def rest(self) -> None:
        """Begin anew."""
        self._yaw = self._told = math.nan  # at the last look, and what the tyres told then [rad]
        self._looked_ns = 0

    def look(self) -> float:
        """Return how much farther the right wheel has come than its tyre tells, since last time.

        In metres; the left one has come as much less far. It is 0 where it is too much for a
        remainder, and where a wheel's radius is unknown.
        """
        right, left = self._right, self._left
        if not (self._track and right.radius and left.radius):
            return 0.0
        way = right.joint.position * right.radius - left.joint.position * left.radius
        yaw, told = yaw_of(self._model.pose.orientation), way / self._track
        now_ns = self._clock.now_ns
        turned = math.remainder(yaw - self._yaw, math.tau) - (told - self._told)
        farther = turned * self._track / 2.0
        most = MOST * (now_ns - self._looked_ns) / NANOSECONDS
        self._yaw, self._told, self._looked_ns = yaw, told, now_ns
        return farther if abs(farther) <= most else 0.0  # NaN is not
