"""Parser and writer of SDF: models, lights and worlds."""

from .sdf import load_sdf, load_sdf_light
from .world_file import open_world
from .world_writer import sdf_of_light, sdf_of_world
from .writer import copy_of_model, sdf_of_include, sdf_of_model

__all__ = [
    'copy_of_model',
    'load_sdf',
    'load_sdf_light',
    'open_world',
    'sdf_of_include',
    'sdf_of_light',
    'sdf_of_model',
    'sdf_of_world',
]
