"""Gazebo's empty world."""

from ..core import IDENTITY
from ..description import GROUND_PLANE, SUN
from .world import World


def add_empty_world(world: World) -> None:
    """Add the content of Gazebo's empty world: an infinite ground at z = 0, and the sun."""
    world.spawn(GROUND_PLANE, GROUND_PLANE.name, IDENTITY)
    world.lights[SUN.name] = SUN
