"""From mesh files to clean triangles, and to the files that a physics engine gets."""

from ..resources import HeldFile
from .engine_files import EngineFiles
from .loader import MeshPart, check_mesh, load_readers, read_mesh, visual_parts
from .stl import read_stl
from .submesh import submesh_file
from .support_points import support_points

__all__ = [
    'EngineFiles', 'HeldFile', 'MeshPart', 'check_mesh', 'load_readers', 'read_mesh', 'read_stl',
    'submesh_file', 'support_points', 'visual_parts',
]
