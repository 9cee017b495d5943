"""Stiffness, damping, penetration correction and restitution of contacts, for PyBullet."""

import math
from dataclasses import replace

from ...description import FIXED, Surface
from .generated_urdf import Tree

_GRAVITY = 9.8  # [m/s^2]
_MAX_STIFFNESS = 1e12  # [N/m] SDF's default for kp

# Deflection of one contact under the whole weight of a robot [m]. With more than three rigid
# contacts the load distribution is statically indeterminate; this compliance determines it.
_DEFLECTION = 1e-3
_PARTING_SPEED = 1.0  # [m/s] for bodies that overlap by their whole size
_MIN_REACH = 5e-6  # [m] smaller bodies separate at the rate of this size
_PARTS_FREELY = 1.0  # [m/s] least max_vel that allows a bounce
_MAX_IMPACT_SPEED = 100.0  # [m/s] a higher threshold means no bounce


def restitution(surface: Surface) -> float:
    """Return the restitution of a surface for PyBullet, which multiplies those of a pair.

    Gazebo takes the lesser of a pair, and limits the rebound speed to `max_vel`, 0.01 m/s by
    default. The square root agrees with Gazebo if both are equal or one of them is 0.
    """
    if surface.max_vel < _PARTS_FREELY or surface.threshold > _MAX_IMPACT_SPEED:
        return 0.0
    return math.sqrt(min(1.0, max(0.0, surface.restitution)))


def overlap_share(step_size: float, rate: float) -> float:
    """Return the share of a penetration that contacts correct in a step (PyBullet's ERP).

    Args:
        step_size: duration of the step [s].
        rate: of the correction [1/s].
    """
    return min(0.2, rate * step_size)


def parting_rate(reach: float, push_out: float) -> float:
    """Return the rate at which contacts correct penetration [1/s].

    Args:
        reach: size of the body [m], an upper bound of its penetration.
        push_out: the rate for small bodies [1/s].
    """
    return min(push_out, _PARTING_SPEED / max(reach, _MIN_REACH))


def jointed_mass(tree: Tree) -> float:
    """Return the mass [kg] of a tree with movable joints; 0 if it has none or its root is fixed."""
    if tree.fixed_base or all(joint is None or joint.type == FIXED for joint in tree.joints):
        return 0.0
    return sum(link.inertial.mass for link in tree.links if link.inertial)


def compliant(surface: Surface, mass: float) -> Surface:
    """Return a surface with kp limited for a robot of that mass [kg]; 0 means no limit."""
    stiffest = mass * _GRAVITY / _DEFLECTION
    return replace(surface, kp=stiffest) if 0.0 < stiffest < surface.kp else surface


def is_rigid(surface: Surface) -> bool:
    """Tell whether the stiffness of a surface is SDF's default, which counts as rigid."""
    return surface.kp >= _MAX_STIFFNESS


def contact_spring(surface: Surface, step_size: float, rate: float) -> tuple[float, float]:
    """Return stiffness [N/m] and damping [N s/m] of a contact of a compliant surface.

    Its static deflection is force / kp. Damping is at least what keeps it from separating bodies
    faster than rigid contacts do; a lower kd could eject them. `rate` as in `overlap_share`.
    """
    least = step_size * surface.kp * (1.0 / overlap_share(step_size, rate) - 1.0)
    return surface.kp, max(surface.kd, least)
