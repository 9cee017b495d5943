"""Mesh files for the physics engine: clean, reduced, written once and used again.

Collisions of moving bodies are convex hulls, those of standing ones exact surfaces. They are
written as plain .stl and .obj files named by what they hold, so that all models share them, and
removed when no model uses them any more.
"""

import hashlib
import math
from functools import lru_cache

import numpy as np

from ..core import Vector
from ..core.arrays import FloatArray, IntArray
from ..description import Mesh
from ..description.inertia import settle
from ..resources import HeldFile, HeldFiles
from .loader import MeshData, read_mesh
from .stl import write_stl
from .support_points import support_points

# The hull of more vertices than this is that of its extreme points in as many directions: no
# direction is more than 0.12 rad from one of them, so a ball loses less than 0.7 % of its radius.
HULL_DIRECTIONS = 512


class EngineFiles:
    """Makes the engine's mesh files, each as long as it is held. Any thread may ask for files."""

    def __init__(self) -> None:
        self._files = HeldFiles('rosbots_meshes_')

    def engine_file(self, mesh: Mesh, exact: bool) -> HeldFile:
        """Return the file of a mesh: its exact surface, or its hull."""
        make = self.collision_surface if exact else self.collision_hull
        return make(mesh.path, mesh.scale)

    def collision_hull(self, path: str, scale: Vector = (1.0, 1.0, 1.0)) -> HeldFile:
        """Return the .stl file of the convex hull of the whole mesh, for bodies that move.

        The file holds the points to be hulled, which the engine does itself; its faces only
        make every point count. At most HULL_DIRECTIONS + 6 points, exact where there are few.

        Raises:
            ModelError: the mesh cannot be read (see `check_mesh`), or nothing can be written.
        """
        return self._file('hull', path, scale)

    def collision_surface(self, path: str, scale: Vector = (1.0, 1.0, 1.0)) -> HeldFile:
        """Return the .obj file of the mesh's exact triangles, for bodies that stand.

        Raises:
            ModelError: the mesh cannot be read (see `check_mesh`), or nothing can be written.
        """
        return self._file('surface', path, scale)

    def close(self) -> None:
        """Remove all files."""
        self._files.close()

    def _file(self, kind: str, path: str, scale: Vector) -> HeldFile:
        mesh = read_mesh(path)
        key = hashlib.sha256(repr((kind, mesh.digest, *map(float, scale))).encode())
        # Of an .obj PyBullet makes a compound with the hull in it, of a .stl the hull itself.
        name = f'{kind}_{key.hexdigest()[:32]}.{"stl" if kind == "hull" else "obj"}'
        return self._files.get(name) or self._files.write(name, _converted(kind, mesh, scale), path)


def _converted(kind: str, mesh: MeshData, scale: Vector) -> bytes:
    """Return the content of an engine file."""
    vertices, faces = mesh.triangles()
    vertices = vertices * np.asarray(scale)
    if kind == 'hull':
        vertices, faces = _hull(vertices[np.unique(faces)])
        return write_stl(vertices[faces])
    if np.prod(np.sign(scale)) < 0.0:
        faces = faces[:, ::-1]  # a mirror turns the triangles inside out
    return _obj(vertices, faces).encode()


def _hull(points: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return points that span nearly the hull of `points`, and triangles that use each of them."""
    points = _distinct(points)
    if len(points) > HULL_DIRECTIONS:
        points = points[support_points(points, _directions())]
    while len(points) < 3:
        points = np.concatenate([points, points[-1:]])
    first = np.arange(len(points) - 2)
    return points, np.stack([first, first + 1, first + 2], axis=1)


def _distinct(points: FloatArray) -> FloatArray:
    """Return what `np.unique(points, axis=0)` returns, in an eighth of the time."""
    points = points[np.lexsort(points.T[::-1])]
    distinct: FloatArray = points[np.append(True, (points[1:] != points[:-1]).any(axis=1))]
    return distinct


@lru_cache(maxsize=1)
def _directions() -> FloatArray:
    """Return evenly spread unit vectors (n, 3): the six axes and a spiral over the sphere.

    The axes come along so that the hull is as long, wide and high as the mesh. Spiral: Fibonacci
    lattice, equal steps in height, turning by the golden angle.
    """
    i = np.arange(HULL_DIRECTIONS)
    height = 1.0 - (2.0 * i + 1.0) / HULL_DIRECTIONS
    angle = i * math.pi * (3.0 - math.sqrt(5.0))
    radius = np.sqrt(1.0 - height**2)
    spiral = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    return settle(np.concatenate([np.eye(3), -np.eye(3), spiral]))


def _obj(vertices: FloatArray, faces: IntArray) -> str:
    lines = ['o mesh']
    lines += ['v {:.9g} {:.9g} {:.9g}'.format(*vertex) for vertex in vertices.tolist()]
    lines += ['f {} {} {}'.format(*face) for face in (faces + 1).tolist()]
    return '\n'.join(lines) + '\n'
