"""Read mesh files as validated triangles, and write the files for a physics engine."""

from ..resources import SharedFile
from .engine_files import EngineFiles
from .extent import extent, rough_extent
from .loader import MeshPart, check_mesh, load_readers, read_mesh
from .stl import read_stl
from .submesh import submesh_file
from .triangle_tree import TriangleTree

__all__ = [
    'EngineFiles',
    'MeshPart',
    'SharedFile',
    'TriangleTree',
    'check_mesh',
    'extent',
    'load_readers',
    'read_mesh',
    'read_stl',
    'rough_extent',
    'submesh_file',
]
