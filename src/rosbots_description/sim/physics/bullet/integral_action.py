"""Integral action of motors: it takes up the velocity error that few solver iterations leave.

A motor acts in each iteration through the wheel's small mass, so that under load a steady error
stays, in proportion to the effort: velocity = target + offset - error. The offset is its integral.
Constants, their mathematics and step responses: doc/physics.md, "Motors".
"""

from typing import NamedTuple

PERIOD = 40  # [steps] between two looks at the motors
GAIN = 0.5  # share of the error by which an offset changes in a look
MOST_SHARE, MOST = 0.15, 1.0  # limit of an offset: share of the target, and [rad/s or m/s]
SATURATED = 0.99  # share of its effort limit from which on a motor counts as saturated
NONE = 5e-4  # [rad/s or m/s] a smaller error counts as none: at rest, wheels leave it each other
NEAR = 0.03  # share of the target: within it, all errors count. Beyond it, a motor is left alone
SHRINKS = 0.98  # that approaches its target by itself: with at most this share of the last error


class Integral(NamedTuple):
    """State of a joint's motor at the last look, all in rad/s or m/s."""

    target: float = 0.0
    error: float = 0.0
    offset: float = 0.0  # what the engine's motor gets in addition to the target


AT_REST = Integral()


def integral(before: Integral, target: float, velocity: float, load: float) -> Integral:
    """Return the state after a look at a motor.

    Args:
        load: effort of the motor relative to its limit.
    """
    error, offset = target - velocity, before.offset
    if target == before.target and abs(load) < SATURATED and abs(error) > NONE:
        lasting = before.error / error  # else an impact at this look would count
        if error * offset < 0.0 and 2.0 * abs(error) > abs(offset):
            offset = 0.0  # the load that it was for is gone
        elif abs(error) < NEAR * abs(target) or lasting < 1.0 / SHRINKS:
            offset += GAIN * error * max(0.0, min(1.0, lasting))
    most = MOST_SHARE * abs(target) + MOST
    return Integral(target, error, max(-most, min(most, offset)))
