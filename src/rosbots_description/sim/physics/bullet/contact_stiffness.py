"""How contacts push back: stiffness, damping, push-out and restitution, in PyBullet's terms."""

import math
from dataclasses import replace

from ...description import FIXED, Surface
from .generated_urdf import Tree

_GRAVITY = 9.8  # [m/s^2]
_STIFFEST = 1e12  # [N/m] the stiffness that SDF gives to contacts nobody described

# Deflection of one contact under all of a robot's weight [m]. Which of more than three rigid points
# carry is undetermined; with this the load spreads as the shapes say.
_DEFLECTION = 1e-3
_PARTING_SPEED = 1.0  # [m/s] at which bodies part that overlap by all of their size
_LEAST_REACH = 5e-6  # [m] what is smaller parts at no higher rate
_PARTS_FREELY = 1.0  # [m/s] a max_vel from which on things may bounce
_FASTEST_IMPACT = 100.0  # [m/s] a threshold beyond which nothing bounces


def restitution(surface: Surface) -> float:
    """Return PyBullet's restitution of a surface: those of a pair are multiplied.

    Gazebo takes the lesser of a pair, and lets nothing part faster than `max_vel`, which is 0.01
    m/s unless somebody sets it. The root gives the same for equal ones, and for a pair of which
    one has none.
    """
    if surface.max_vel < _PARTS_FREELY or surface.threshold > _FASTEST_IMPACT:
        return 0.0
    return math.sqrt(min(1.0, max(0.0, surface.restitution)))


def overlap_share(step_size: float, rate: float) -> float:
    """Return the share of an overlap that contacts take away in a step.

    Args:
        step_size: duration of the step [s].
        rate: at which bodies are pushed apart [1/s].
    """
    return min(0.2, rate * step_size)


def parting_rate(reach: float, push_out: float) -> float:
    """Return the rate at which contacts take away an overlap [1/s].

    Args:
        reach: the size of what overlaps [m]; nothing can overlap by more.
        push_out: the rate for small things [1/s].
    """
    return min(push_out, _PARTING_SPEED / max(reach, _LEAST_REACH))


def jointed_mass(tree: Tree) -> float:
    """Return the mass [kg] of links that move on joints; 0 if the root is fixed."""
    if tree.fixed_base or all(joint is None or joint.type == FIXED for joint in tree.joints):
        return 0.0
    return sum(link.inertial.mass for link in tree.links if link.inertial)


def compliant(surface: Surface, mass: float) -> Surface:
    """Return a surface that gives way at least as a robot of that mass [kg] does; 0 for none."""
    stiffest = mass * _GRAVITY / _DEFLECTION
    return replace(surface, kp=stiffest) if 0.0 < stiffest < surface.kp else surface


def is_rigid(surface: Surface) -> bool:
    """Tell whether nobody described how a surface gives way."""
    return surface.kp >= _STIFFEST


def contact_spring(surface: Surface, step_size: float, rate: float) -> tuple[float, float]:
    """Return stiffness [N/m] and damping [N s/m] of a contact of a surface that gives way.

    It gives way by force / kp at rest, and is damped so much that it parts bodies no faster than
    other contacts do; a kd of a user's could shoot them away. `rate` as in `overlap_share`.
    """
    least = step_size * surface.kp * (1.0 / overlap_share(step_size, rate) - 1.0)
    return surface.kp, max(surface.kd, least)
