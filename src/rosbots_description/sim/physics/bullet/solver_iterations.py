"""Adapts the number of solver iterations: more while an unsaturated motor misses its target.

If a wheel is light relative to its robot, the solver converges slowly on the motor's force. The
residual is a velocity error, which matters most at low speed: on ramps, when creeping or parked.
"""

from collections.abc import Callable, Iterable
from typing import Any

CHECK = 40  # steps between two checks of the motors
# Allowed relative velocity error of a motor on each level but the last. It is greater on the first
# level, whose iterations cost least.
MISSED = (0.04, 0.015)
REACHED = 0.009  # relative error below which fewer iterations are tried
SLOWEST = 0.05  # [rad/s or m/s] lower bound of the target in the relative error
STILL = 0.0025  # [rad/s or m/s] in its place for a target of 0: a parked robot must not creep
SATURATED = 0.99  # share of its effort limit from which on a motor counts as saturated
SMOOTHING = 0.2  # weight of a new sample in the exponential mean
FACTOR = 4  # of iterations between two levels
PATIENCE, MAX_PATIENCE = 4, 256  # checks before fewer iterations are tried: at first, at most

Motor = tuple[float, float, float, float]  # velocity, its target, effort, its limit


class SolverEffort:
    """Sets the number of solver iterations by the velocity errors of motors.

    Whether fewer suffice is found by trial. The wait doubles after each failed trial, until a
    target changes.
    """

    def __init__(self, set_iterations: Callable[[int], None]) -> None:
        """Prepare; `start` sets the number for the first time."""
        self._set_iterations = set_iterations

    def start(self, least: int) -> None:
        """Start with the least number of iterations."""
        self._least, self._level, self._missed = least, 0, 0.0
        self._targets: list[float] = []
        self._patience, self._wait = PATIENCE, 0  # checks
        self._set_iterations(least)

    def update(self, motors: Iterable[Motor]) -> None:
        """Update the number of iterations from the current state of the motors."""
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

    def save_state(self) -> tuple[Any, ...]:
        """Return the state for `restore_state`."""
        return (self._least, self._level, self._missed, self._targets, self._patience, self._wait)

    def restore_state(self, saved: tuple[Any, ...]) -> None:
        """Restore the state of a note."""
        (self._least, self._level, self._missed, self._targets, self._patience, self._wait) = saved
        self._set_iterations(self._least * FACTOR**self._level)

    def _shift(self, levels: int) -> None:
        self._level += levels
        self._missed = (REACHED + MISSED[-1]) / 2.0  # initial guess
        self._set_iterations(self._least * FACTOR**self._level)


def _missed(velocity: float, target: float, effort: float, limit: float) -> float:
    """Return the relative velocity error of a motor; 0 if it is saturated."""
    if abs(effort) >= SATURATED * limit:
        return 0.0
    return abs(velocity - target) / (max(abs(target), SLOWEST) if target else STILL)
