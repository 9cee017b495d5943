"""Parser of URDF, by the rules of sdformat 9."""

from .robot_control import load_robot_control
from .urdf import load_urdf
from .xacro_files import expand_xacro

__all__ = ['expand_xacro', 'load_robot_control', 'load_urdf']
