"""Limits of a commanded velocity and of its first two time derivatives."""

from typing import NamedTuple

from ..parameters import ControllerParameters


class Bounds(NamedTuple):
    """The least and the greatest value, e.g. of a velocity [m/s or rad/s]."""

    least: float
    most: float

    def clamp(self, value: float) -> float:
        """Return the closest value within the bounds."""
        return min(max(self.least, value), self.most)


class SpeedLimiter(NamedTuple):
    """Bounds of velocity, acceleration and jerk; None where there are none."""

    velocity: Bounds | None = None
    acceleration: Bounds | None = None
    jerk: Bounds | None = None

    @classmethod
    def from_parameters(cls, params: ControllerParameters) -> 'SpeedLimiter':
        """Return the limits of has_X_limits, max_X and min_X; min_X is -max_X by default."""

        def bounds(what: str) -> Bounds | None:
            most = params.read(f'max_{what}', 0.0)
            least = params.read(f'min_{what}', -most)
            return Bounds(least, most) if params.read(f'has_{what}_limits', False) else None

        return cls(bounds('velocity'), bounds('acceleration'), bounds('jerk'))

    def limit(self, wanted: float, last: float, before: float, period: float) -> float:
        """Return the permitted velocity.

        Args:
            last: the velocity one `period` [s] ago; `before` is that of two periods ago.
        """
        speed = wanted
        if self.jerk is not None:
            change, twice = last - before, 2.0 * period * period
            jerk = Bounds(self.jerk.least * twice, self.jerk.most * twice)
            speed = last + change + jerk.clamp(speed - last - change)
        if self.acceleration is not None:
            step = Bounds(self.acceleration.least * period, self.acceleration.most * period)
            speed = last + step.clamp(speed - last)
        return speed if self.velocity is None else self.velocity.clamp(speed)
