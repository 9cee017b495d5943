"""Reads URDF by the rules of sdformat 9."""

from .gazebo_tags import ENDLESS_FRICTION, inject_namespace
from .urdf import load_urdf

__all__ = ['ENDLESS_FRICTION', 'inject_namespace', 'load_urdf']
