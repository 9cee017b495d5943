"""Tyres that give way: in a direction with slip compliance s a contact slides by v = s F.

That is the force-dependent slip of ODE's `slip1` and `slip2` [m/s per N]. PyBullet has none, but
takes a share of a contact's friction along each axis of a body. So the friction that is left to a
contact before each step is the force that belongs to its slip, by implicit Euler. It only ever
takes from the friction there is: never more than mu N, never any work.
"""

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

from ...core import Vector, add, cross, dot, subtract

GRAVITY = 9.8  # [m/s^2] that makes a weight of the mass which a contact carries
NONE_SLIPS = (1.0, 1.0)  # shares of the friction that a tyre without slip holds
MIN_SHARE = 1e-3  # share of the friction that is left to a contact at least


class Touch(NamedTuple):
    """A contact of a tyre in the last step; all vectors are in the world."""

    place: Vector  # [m]
    normal: Vector  # unit, towards the tyre
    load: float  # normal force [N]
    force: Vector  # friction on the tyre [N]
    velocity: Vector  # of the tyre there, relative to what it touches [m/s]
    limit: float  # friction that the pair can hold at most [N]


def shares(
    touches: Iterable[Touch], axle: Vector, slips: tuple[float, float], step_size: float,
    reach: Callable[[Vector], float],
) -> tuple[float, float] | None:
    """Return which shares of its friction a tyre holds, along the axle and ahead; None in the air.

    Args:
        axle: unit vector in the world.
        slips: compliance along the axle and ahead [m/s per N].
        step_size: [s].
        reach: how many times its limit friction can hold in a direction.
    """
    touches = [touch for touch in touches if touch.load > 0.0 and touch.limit > 0.0]
    if not touches:
        return None
    load, limit = sum(touch.load for touch in touches), sum(touch.limit for touch in touches)
    gain = step_size * GRAVITY / load  # that a step of 1 N makes in the speed [m/s per N]
    found = []
    for slip, direction in zip(slips, _directions(touches, axle), strict=True):
        force = sum(dot(touch.force, direction) for touch in touches)
        speed = sum(dot(touch.velocity, direction) * touch.load for touch in touches) / load
        held = abs(force * gain - speed) / (slip + gain)
        found.append(min(1.0, max(MIN_SHARE, held / (limit * reach(direction)))))
    return (found[0], found[1])


def _directions(touches: list[Touch], axle: Vector) -> tuple[Vector, Vector]:
    """Return the directions along the axle and ahead, in the plane that is touched."""
    normal = touches[0].normal
    ahead = cross(axle, normal)
    length = math.hypot(*ahead) or 1.0
    ahead = (ahead[0] / length, ahead[1] / length, ahead[2] / length)
    return cross(normal, ahead), ahead


def velocity_at(place: Vector, origin: Vector, linear: Vector, angular: Vector) -> Vector:
    """Return the velocity of a place of a body whose origin moves so."""
    return add(linear, cross(angular, subtract(place, origin)))
