"""Rays cast against the collisions of a world."""

from .fan import RayFan, Sweep, directions
from .scene import RayScene

__all__ = ['RayFan', 'RayScene', 'Sweep', 'directions']
