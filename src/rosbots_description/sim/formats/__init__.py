"""Parsers, one folder per format, and a writer of SDF; each error names file and line."""

from .sdf import (
    copy_of_model,
    load_sdf,
    load_sdf_light,
    open_world,
    sdf_of_include,
    sdf_of_light,
    sdf_of_model,
    sdf_of_world,
)
from .urdf import expand_xacro, load_robot_control, load_urdf

__all__ = [
    'copy_of_model',
    'expand_xacro',
    'load_robot_control',
    'load_sdf',
    'load_sdf_light',
    'load_urdf',
    'open_world',
    'sdf_of_include',
    'sdf_of_light',
    'sdf_of_model',
    'sdf_of_world',
]
