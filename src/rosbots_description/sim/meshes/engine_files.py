"""Mesh files for the physics engine: validated, reduced, written once and shared.

Collisions of moving bodies are convex hulls, those of static ones exact surfaces. They are written
as plain .stl and .obj files named by a hash of their content, so that models share them, and
removed when no model uses them any more.
"""

import hashlib
import math
from functools import lru_cache

import numpy as np

from ..core import Vector
from ..core.arrays import FloatArray, IntArray
from ..description import Mesh
from ..description.inertia import rounded
from ..resources import SharedFile, SharedFiles
from .loader import MeshData, read_mesh
from .stl import write_stl
from .support_points import support_points

# The hull of more vertices than this is that of its support points in as many directions: no
# direction is more than 0.12 rad from one of them, so a sphere loses less than 0.7 % of its radius.
HULL_DIRECTIONS = 512


class EngineFiles:
    """Writes the engine's mesh files, each kept while it is held. Thread-safe."""

    def __init__(self) -> None:
        self._files = SharedFiles('rosbots_meshes_')

    def engine_file(self, mesh: Mesh, exact: bool) -> SharedFile:
        """Return the .obj file of a mesh's exact triangles, or the .stl file of its convex hull.

        That of the hull holds the points of which the engine computes it; its faces only ensure
        that every point is used. At most HULL_DIRECTIONS + 6 points, exact for small meshes.

        Args:
            exact: for static bodies; the hull is for moving ones.
        Raises:
            ModelError: the mesh cannot be read (see `check_mesh`), or nothing can be written.
        """
        data, kind = read_mesh(mesh.path), 'surface' if exact else 'hull'
        key = hashlib.sha256(repr((kind, data.digest, *map(float, mesh.scale))).encode())
        # PyBullet loads an .obj as a compound with the hull in it, a .stl as the hull itself.
        name = f'{kind}_{key.hexdigest()[:32]}.{"obj" if exact else "stl"}'
        return self._files.get(name) or self._files.write(
            name, _converted(data, mesh.scale, exact), mesh.path
        )

    def close(self) -> None:
        """Remove all files."""
        self._files.close()


def _converted(mesh: MeshData, scale: Vector, exact: bool) -> bytes:
    """Return the content of an engine file."""
    vertices, faces = mesh.triangles()
    vertices = vertices * np.asarray(scale)
    if not exact:
        vertices, faces = _hull(vertices[np.unique(faces)])
        return write_stl(vertices[faces])
    if np.prod(np.sign(scale)) < 0.0:
        faces = faces[:, ::-1]  # a mirror turns the triangles inside out
    return _obj(vertices, faces).encode()


def _hull(points: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return points whose hull approximates that of `points`, and triangles that use them all."""
    points = _distinct(points)
    if len(points) > HULL_DIRECTIONS:
        points = points[support_points(points, _directions())]
    while len(points) < 3:
        points = np.concatenate([points, points[-1:]])
    first = np.arange(len(points) - 2)
    return points, np.stack([first, first + 1, first + 2], axis=1)


def _distinct(points: FloatArray) -> FloatArray:
    """Return `np.unique(points, axis=0)`, computed eight times as fast."""
    points = points[np.lexsort(points.T[::-1])]
    distinct: FloatArray = points[np.append(True, (points[1:] != points[:-1]).any(axis=1))]
    return distinct


@lru_cache(maxsize=1)
def _directions() -> FloatArray:
    """Return evenly spread unit vectors (n, 3): the six axes and a spiral over the sphere.

    The axes make the hull as long, wide and high as the mesh. The spiral is a Fibonacci lattice:
    equal steps in height, each turned by the golden angle.
    """
    i = np.arange(HULL_DIRECTIONS)
    height = 1.0 - (2.0 * i + 1.0) / HULL_DIRECTIONS
    angle = i * math.pi * (3.0 - math.sqrt(5.0))
    radius = np.sqrt(1.0 - height**2)
    spiral = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    return rounded(np.concatenate([np.eye(3), -np.eye(3), spiral]))


def _obj(vertices: FloatArray, faces: IntArray) -> str:
    lines = ['o mesh']
    lines += ['v {:.9g} {:.9g} {:.9g}'.format(*vertex) for vertex in vertices.tolist()]
    lines += ['f {} {} {}'.format(*face) for face in (faces + 1).tolist()]
    return '\n'.join(lines) + '\n'
