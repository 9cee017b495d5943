"""How many iterations the solver makes: more while a motor with effort to spare misses its target.

A wheel that is light beside its robot passes the motor's force on slowly, iteration by iteration.
What is left over in a step is a velocity, so slow robots feel it most: on ramps, at creeping speed,
parked.
"""

from collections.abc import Callable, Iterable
from typing import Any

CHECK = 40  # steps between two looks at the motors
# Share of its target by which a motor may miss it on each level but the last. The least number of
# iterations costs least and may miss by more; who needs more of them anyway gets enough.
MISSED = (0.04, 0.015)
REACHED = 0.009  # fewer will do
SLOWEST = 0.05  # [rad/s or m/s] targets below count as this
STILL = 0.0025  # [rad/s or m/s] what a target of 0 counts as: who is parked is not to creep
SATURATED = 0.99  # share of its effort from which on a motor does what it can
SMOOTHING = 0.2  # weight of a look in the mean
FACTOR = 4  # between two levels
PATIENCE, MAX_PATIENCE = 4, 256  # looks before fewer iterations are tried, at first and at most

Motor = tuple[float, float, float, float]  # velocity, its target, effort, its limit


class SolverEffort:
    """Watches motors and sets the number of the solver's iterations.

    Whether fewer would do shows only when they are tried. After each try that fails it waits twice
    as long, until a target changes.
    """

    def __init__(self, set_iterations: Callable[[int], None]) -> None:
        """Describe it; `start` sets the least number."""
        self._set_iterations = set_iterations
        self._least, self._level, self._missed = 1, 0, 0.0
        self._targets: list[float] = []
        self._patience = self._wait = 0  # looks

    def start(self, least: int) -> None:
        """Begin anew with the least number of iterations."""
        self._least, self._level, self._missed = least, 0, 0.0
        self._targets, self._patience, self._wait = [], PATIENCE, 0
        self._set_iterations(least)

    def look(self, motors: Iterable[Motor]) -> None:
        """Take the motors into account as they are now."""
        motors = list(motors)
        targets = [motor[1] for motor in motors]
        if targets != self._targets:
            self._targets, self._patience = targets, PATIENCE
            self._wait = min(self._wait, PATIENCE)
        worst = max((_missed(*motor) for motor in motors), default=0.0)
        self._missed += (min(worst, 1.0) - self._missed) * SMOOTHING
        self._wait -= 1
        if self._level < len(MISSED) and self._missed > MISSED[self._level]:
            self._shift(1)
            self._wait = self._patience
            self._patience = min(2 * self._patience, MAX_PATIENCE)
        elif self._level and self._missed < REACHED and self._wait < 0:
            self._shift(-1)

    def note(self) -> tuple[Any, ...]:
        """Return what `recall` takes to go back to the present state."""
        return (self._least, self._level, self._missed, self._targets, self._patience, self._wait)

    def recall(self, note: tuple[Any, ...]) -> None:
        """Go on as at the time of a note."""
        (self._least, self._level, self._missed, self._targets, self._patience, self._wait) = note
        self._set_iterations(self._least * FACTOR**self._level)

    def _shift(self, levels: int) -> None:
        self._level += levels
        self._missed = (REACHED + MISSED[-1]) / 2.0  # until it is known
        self._set_iterations(self._least * FACTOR**self._level)


def _missed(velocity: float, target: float, effort: float, limit: float) -> float:
    """Return the share of its target by which a motor misses it; 0 if it does what it can."""
    if abs(effort) >= SATURATED * limit:
        return 0.0
    return abs(velocity - target) / (max(abs(target), SLOWEST) if target else STILL)
