"""In which directions a surface holds how much, in PyBullet's terms."""

import math
from typing import Any

from ...core import ALONG, Quaternion, Vector, conjugate, rotate
from ...description import Collision, LinkSpec, Surface
from .body import Body, FrictionAxes
from .friction_pairs import MAX_FRICTION

EVENLY = (1.0, 1.0, 1.0)  # shares of friction held along the axes of a part


def directions(collision: Collision) -> tuple[Any, ...]:
    """Return what tells apart the directions of friction; nothing if it has none."""
    surface = collision.surface
    if _is_even(surface, MAX_FRICTION):
        return ()
    first = surface.fdir1
    return surface.mu, surface.mu2, any(first) and rotate(collision.pose.orientation, first)


def first_direction(collision: Collision, link: LinkSpec) -> Vector:
    """Return the first direction of a collision's friction in the frame of its link, a unit vector.

    Without `fdir1` ODE takes the world's y axis on level ground; here it is that of the model, so
    that friction turns with what it belongs to.
    """
    given = collision.surface.fdir1
    length = math.hypot(*given)
    if not length:
        return rotate(conjugate(link.pose.orientation), (0.0, 1.0, 0.0))
    x, y, z = given
    return rotate(collision.pose.orientation, (x / length, y / length, z / length))


def friction_scales(
    collision: Collision, link: LinkSpec, turn: Quaternion, friction: float
) -> tuple[float, float, float]:
    """Return which shares of its greatest friction a part holds along each of its own axes.

    PyBullet can weaken it along these alone; where the first direction of friction is none of them
    the part holds alike in all.

    Args:
        turn: turns the part's axes into those of the link.
        friction: what PyBullet is given for the part.
    """
    surface = collision.surface
    if _is_even(surface, friction):
        return EVENLY
    first = rotate(conjugate(turn), first_direction(collision, link))
    along = [abs(component) > ALONG for component in first]
    if not any(along):
        return EVENLY
    greatest = min(friction, surface.greatest_mu)
    share, other = (min(1.0, mu / greatest) for mu in (surface.mu, surface.mu2))
    x, y, z = (share if is_first else other for is_first in along)
    return (x, y, z)


def _is_even(surface: Surface, most: float) -> bool:
    """Tell whether a surface holds alike in all directions up to a friction coefficient."""
    return min(surface.mu, surface.mu2) >= min(most, surface.greatest_mu)


def can_slip(body: Body, link: str, axle: Vector) -> bool:
    """Tell whether a link can slip along an axis of its frame: its parts must have it, too."""
    return all(any(axes_along(body.friction_axes[place], axle)) for place in body.surfaces[link])


def axes_along(axes: FrictionAxes, direction: Vector) -> list[bool]:
    """Tell which axis of a part a direction of the link's frame is."""
    return [abs(component) > ALONG for component in rotate(conjugate(axes.turn), direction)]
