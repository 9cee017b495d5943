"""Anisotropic friction of surfaces, as PyBullet takes it."""

import math
from typing import Any

from ...core import ALONG, Quaternion, Vector, conjugate, rotate
from ...description import Collision, LinkSpec, Surface
from .body import Body, FrictionAxes
from .friction_pairs import MAX_FRICTION

ISOTROPIC = (1.0, 1.0, 1.0)  # friction scales along the axes of a part


def directions(collision: Collision) -> tuple[Any, ...]:
    """Return a key for the anisotropic friction of a collision; () if it is isotropic."""
    surface = collision.surface
    if _is_isotropic(surface, MAX_FRICTION):
        return ()
    first = surface.fdir1
    return surface.mu, surface.mu2, any(first) and rotate(collision.pose.orientation, first)


def first_direction(collision: Collision, link: LinkSpec) -> Vector:
    """Return the first friction direction of a collision as a unit vector in its link's frame.

    Without `fdir1` ODE uses the world's y axis on level ground; here it is the model's y axis, so
    that the direction rotates with the model.
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
    """Return the friction scales of a part along its own axes, 0 to 1.

    PyBullet scales friction along these axes only. If the first friction direction is not one of
    them, friction is isotropic.

    Args:
        turn: rotation of the part's axes into the link's axes.
        friction: coefficient that PyBullet is given for the part.
    """
    surface = collision.surface
    if _is_isotropic(surface, friction):
        return ISOTROPIC
    first = rotate(conjugate(turn), first_direction(collision, link))
    along = [abs(component) > ALONG for component in first]
    if not any(along):
        return ISOTROPIC
    greatest = min(friction, surface.greatest_mu)
    share, other = (min(1.0, mu / greatest) for mu in (surface.mu, surface.mu2))
    x, y, z = (share if is_first else other for is_first in along)
    return (x, y, z)


def _is_isotropic(surface: Surface, most: float) -> bool:
    """Tell whether friction is isotropic, with coefficients clamped to `most`."""
    return min(surface.mu, surface.mu2) >= min(most, surface.greatest_mu)


def can_slip(body: Body, link: str, axle: Vector) -> bool:
    """Tell whether a link can slip along an axis: it must be an axis of each of its parts."""
    return all(any(axes_along(body.friction_axes[place], axle)) for place in body.surfaces[link])


def axes_along(axes: FrictionAxes, direction: Vector) -> list[bool]:
    """Tell for each axis of a part whether a direction in the link's frame is along it."""
    return [abs(component) > ALONG for component in rotate(conjugate(axes.turn), direction)]
