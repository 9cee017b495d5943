"""How many iterations the solver makes: more while a motor with effort to spare misses its target.

A wheel that is light beside its robot passes the motor's force on slowly, iteration by iteration.
What is left over in a step is a velocity, so slow robots feel it most: on ramps, at creeping speed.
"""

from collections.abc import Callable, Iterable

CHECK = 20  # steps between two looks at the motors
MISSED = 0.04  # share of its target by which a motor misses it: make more iterations
REACHED = MISSED / 8.0  # fewer will do
SLOWEST = 0.05  # [rad/s or m/s] targets below count as this
SATURATED = 0.99  # share of its effort from which on a motor does what it can
SMOOTHING = 0.1  # weight of a look in the mean
FACTOR = 4  # between two levels
LEVELS = 3

Motor = tuple[float, float, float, float]  # velocity, its target, effort, its limit


class SolverEffort:
    """Watches motors and sets the number of the solver's iterations."""

    def __init__(self, set_iterations: Callable[[int], None]) -> None:
        """Describe it; `start` sets the least number."""
        self._set_iterations = set_iterations
        self._least = 1
        self._level = 0
        self._missed = 0.0  # smoothed

    def start(self, least: int) -> None:
        """Begin anew with the least number of iterations."""
        self._least, self._level, self._missed = least, 0, 0.0
        self._set_iterations(least)

    def look(self, motors: Iterable[Motor]) -> None:
        """Take the motors into account as they are now."""
        worst = max((_missed(*motor) for motor in motors), default=0.0)
        self._missed += (min(worst, 1.0) - self._missed) * SMOOTHING
        if self._missed > MISSED and self._level < LEVELS - 1:
            self._shift(1)
        elif self._missed < REACHED and self._level:
            self._shift(-1)

    def _shift(self, levels: int) -> None:
        self._level += levels
        self._missed = (MISSED + REACHED) / 2.0  # until it is known
        self._set_iterations(self._least * FACTOR**self._level)


def _missed(velocity: float, target: float, effort: float, limit: float) -> float:
    """Return the share of its target by which a motor misses it; 0 if it does what it can."""
    if abs(effort) >= SATURATED * limit:
        return 0.0
    return abs(velocity - target) / max(abs(target), SLOWEST)
