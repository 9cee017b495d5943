"""Slip compliance s of a tyre: its contact slides at v = s F in the direction of the force F.

This is the force-dependent slip of ODE's `slip1` and `slip2` [m/s per N]. PyBullet has no slip, but
scales the friction of a contact along each axis of a body. Before each step the scale is set so
that friction is the force of the slip, by implicit Euler: F = |F0 g - v| / (s + g), with the
velocity gain g = dt / m. Friction only decreases: it stays below mu N and does no positive work.
"""

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

from ...core import Vector, add, cross, dot, subtract

GRAVITY = 9.8  # [m/s^2] estimates the mass on a contact from its load
NONE_SLIPS = (1.0, 1.0)  # friction scales without slip
MIN_SHARE = 1e-3  # least friction scale


class Touch(NamedTuple):
    """A contact of a tyre in the last step; all vectors are in the world."""

    place: Vector  # [m]
    normal: Vector  # unit, towards the tyre
    load: float  # normal force [N]
    force: Vector  # friction on the tyre [N]
    velocity: Vector  # of the tyre there, relative to what it touches [m/s]
    limit: float  # mu N of the pair [N]


def shares(
    touches: Iterable[Touch], axle: Vector, slips: tuple[float, float], step_size: float,
    reach: Callable[[Vector], float],
) -> tuple[float, float] | None:
    """Return the friction scales of a tyre along the axle and ahead; None without contact.

    Args:
        axle: unit vector in the world.
        slips: compliance along the axle and ahead [m/s per N].
        step_size: [s].
        reach: ratio of friction to mu N possible in a direction.
    """
    touches = [touch for touch in touches if touch.load > 0.0 and touch.limit > 0.0]
    if not touches:
        return None
    load, limit = sum(touch.load for touch in touches), sum(touch.limit for touch in touches)
    gain = step_size * GRAVITY / load  # change of speed by 1 N in a step [m/s per N]
    found = []
    for slip, direction in zip(slips, _directions(touches, axle), strict=True):
        force = sum(dot(touch.force, direction) for touch in touches)
        speed = sum(dot(touch.velocity, direction) * touch.load for touch in touches) / load
        held = abs(force * gain - speed) / (slip + gain)
        found.append(min(1.0, max(MIN_SHARE, held / (limit * reach(direction)))))
    return (found[0], found[1])


def _directions(touches: list[Touch], axle: Vector) -> tuple[Vector, Vector]:
    """Return the directions along the axle and ahead, in the contact plane."""
    normal = touches[0].normal
    ahead = cross(axle, normal)
    length = math.hypot(*ahead) or 1.0
    ahead = (ahead[0] / length, ahead[1] / length, ahead[2] / length)
    return cross(normal, ahead), ahead


def velocity_at(place: Vector, origin: Vector, linear: Vector, angular: Vector) -> Vector:
    """Return the velocity of a point of a body, given the twist at its origin."""
    return add(linear, cross(angular, subtract(place, origin)))
