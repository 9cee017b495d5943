"""Parser of URDF, by the rules of sdformat 9."""

from .urdf import load_urdf
from .xacro_files import expand_xacro

__all__ = ['expand_xacro', 'load_urdf']
