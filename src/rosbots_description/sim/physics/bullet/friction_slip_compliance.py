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
FULL_FRICTION = (1.0, 1.0)  # friction scales without slip
MIN_SCALE = 1e-3  # least friction scale


class TyreContact(NamedTuple):
    """A contact of a tyre in the last step; all vectors are in the world."""

    place: Vector  # [m]
    normal: Vector  # unit, towards the tyre
    load: float  # normal force [N]
    force: Vector  # friction on the tyre [N]
    velocity: Vector  # of the tyre there, relative to what it touches [m/s]
    limit: float  # mu N of the pair [N]


def slip_scales(
    contacts: Iterable[TyreContact],
    axle: Vector,
    slips: tuple[float, float],
    step_size: float,
    friction_ratio: Callable[[Vector], float],
) -> tuple[float, float] | None:
    """Return the friction scales of a tyre along the axle and ahead; None without contact.

    Args:
        axle: unit vector in the world.
        slips: compliance along the axle and ahead [m/s per N].
        step_size: [s].
        friction_ratio: ratio of friction to mu N possible in a direction.
    """
    contacts = [contact for contact in contacts if contact.load > 0.0 and contact.limit > 0.0]
    if not contacts:
        return None
    load = sum(contact.load for contact in contacts)
    limit = sum(contact.limit for contact in contacts)
    gain = step_size * GRAVITY / load  # change of speed by 1 N in a step [m/s per N]
    found = []
    for slip, direction in zip(slips, _directions(contacts, axle), strict=True):
        force = sum(dot(contact.force, direction) for contact in contacts)
        speed = sum(dot(contact.velocity, direction) * contact.load for contact in contacts) / load
        target = abs(force * gain - speed) / (slip + gain)
        found.append(min(1.0, max(MIN_SCALE, target / (limit * friction_ratio(direction)))))
    return (found[0], found[1])


def _directions(contacts: list[TyreContact], axle: Vector) -> tuple[Vector, Vector]:
    """Return the directions along the axle and ahead, in the contact plane."""
    normal = contacts[0].normal
    ahead = cross(axle, normal)
    length = math.hypot(*ahead) or 1.0
    ahead = (ahead[0] / length, ahead[1] / length, ahead[2] / length)
    return cross(normal, ahead), ahead


def velocity_at(place: Vector, origin: Vector, linear: Vector, angular: Vector) -> Vector:
    """Return the velocity of a point of a body, given the twist at its origin."""
    return add(linear, cross(angular, subtract(place, origin)))
