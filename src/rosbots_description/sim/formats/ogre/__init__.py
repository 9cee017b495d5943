"""Ogre's material scripts, in which models and resource folders define materials."""

from .material_scripts import script_material

__all__ = ['script_material']
