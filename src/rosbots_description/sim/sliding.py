"""Tyres that slide: the wheels of a robot spin as it sets off, or as it comes down from a hop.

Friction is limited along the world's axes each (tuning.py), so a tyre that slides across them is
pushed aside as hard as it is pulled ahead. But friction points against the slip: what slides
straight on is not held sideways at all, and ahead alike at any heading. So wheels that are asked to
run alike hold nothing along their axle while they slide; what moves them aside then, side_friction
brings to rest. Wheels that are asked to stand hold all, sliding or not.
"""

from collections.abc import Sequence

from .body import HOLDS_ALL, Hold
from .wheel import Wheel

JUMP = 0.05  # [m/s] a rim that is asked for that much more or less at once may begin to slide
SLIP = 0.02  # [m/s] a rim that passes the ground slower than that rolls
# Times in a row that tyres must be seen to roll: one that comes down is as fast as the ground once.
ROLLS = 5


class Sliding:
    """Watches two wheels about one axle, and lets go of the ground sideways while they slide."""

    def __init__(self, wheels: Sequence[Wheel]) -> None:
        """Describe them; `rest` lets them hold."""
        self._wheels = wheels
        self._asked: tuple[float, ...] = (0.0,) * len(wheels)  # [rad/s]
        self._rolled = ROLLS  # times in a row that they were seen to roll

    @property
    def slides(self) -> bool:
        """Tell whether they do, or did so just now."""
        return self._rolled < ROLLS

    def rest(self) -> None:
        """Let the tyres hold: they stand still."""
        self._asked = (0.0,) * len(self._wheels)
        self._rolled = ROLLS
        self._hold(HOLDS_ALL)

    def watch(self, asked: Sequence[float], hold: Hold) -> None:
        """Let the tyres hold as much as they do.

        Args:
            asked: speeds of the hubs from now on [rad/s].
            hold: what tyres hold that slide on the way they are to go.
        """
        jumps = any(
            abs(now - then) * (wheel.radius or 0.0) > JUMP
            for wheel, now, then in zip(self._wheels, asked, self._asked, strict=True)
        )
        self._asked = tuple(asked)
        if jumps or any(abs(wheel.slip()) > SLIP for wheel in self._wheels):
            self._rolled = 0
        else:
            self._rolled += 1
        self._hold(hold if self.slides else HOLDS_ALL)

    def _hold(self, hold: Hold) -> None:
        for wheel in self._wheels:
            wheel.hold(hold)
