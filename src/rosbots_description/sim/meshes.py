"""Mesh files for the physics engine: clean, reduced, written once and used again.

Collisions of moving bodies are convex hulls, those of standing ones exact surfaces. Both are
written as plain .obj files named by what they hold, so that respawning finds them ready, and the
next run too if it is given the same directory.
"""

import hashlib
import logging
import math
import os
import tempfile
import threading
from functools import lru_cache
from pathlib import Path

import numpy as np

from .inertia import settle
from .mesh_reading import check_mesh, read_mesh, visual_parts
from .pose import Vector

__all__ = ['MeshStore', 'check_mesh', 'visual_parts']

logger = logging.getLogger(__name__)

# The hull of more vertices than this is that of its extreme points in as many directions: no
# direction is more than 0.12 rad from one of them, so a ball loses less than 0.7 % of its radius.
HULL_DIRECTIONS = 512

_VERSION = '1'  # of the files' layout; a change makes the old ones be left alone


class MeshStore:
    """Keeps the engine's mesh files in a directory. Any thread may ask for files.

    Args:
        cache_dir: made if missing. Without one, or where it cannot be written, a private
            temporary directory serves, which is removed with the store.
    """

    def __init__(self, cache_dir: str | os.PathLike | None = None) -> None:
        self._temporary: tempfile.TemporaryDirectory | None = None
        self._lock = threading.Lock()  # for the directory; files are converted without it
        self._directory = self._prepare(cache_dir)

    @property
    def directory(self) -> Path:
        """The directory in use."""
        return self._directory

    def collision_hull(self, path: str, scale: Vector = (1.0, 1.0, 1.0)) -> str:
        """Return the .obj file of the convex hull of the whole mesh, for bodies that move.

        The file holds the points to be hulled, which the engine does itself; its faces only
        make every point count. At most HULL_DIRECTIONS + 6 points, exact where there are few.

        Raises:
            ModelError: the mesh cannot be read (see `check_mesh`).
        """
        return self._file('hull', path, scale)

    def collision_surface(self, path: str, scale: Vector = (1.0, 1.0, 1.0)) -> str:
        """Return the .obj file of the mesh's exact triangles, for bodies that stand.

        Raises:
            ModelError: the mesh cannot be read (see `check_mesh`).
        """
        return self._file('surface', path, scale)

    def close(self) -> None:
        """Remove the temporary directory, if there is one."""
        with self._lock:
            if self._temporary is not None:
                self._temporary.cleanup()

    def _prepare(self, cache_dir: str | os.PathLike | None) -> Path:
        if cache_dir is not None:
            directory = Path(cache_dir)
            try:
                directory.mkdir(mode=0o700, parents=True, exist_ok=True)
                with tempfile.TemporaryFile(dir=directory):
                    return directory
            except OSError as error:
                logger.warning(
                    'mesh cache %s cannot be written (%s); a temporary one is used',
                    directory, error.strerror,
                )
        return self._use_temporary()

    def _use_temporary(self) -> Path:
        self._temporary = tempfile.TemporaryDirectory(prefix='rosbots_meshes_')
        self._directory = Path(self._temporary.name)
        return self._directory

    def _file(self, kind: str, path: str, scale: Vector) -> str:
        mesh = read_mesh(path)
        key = hashlib.sha256(repr((_VERSION, kind, mesh.digest, *map(float, scale))).encode())
        name = f'{kind}_{key.hexdigest()[:32]}.obj'
        file = self._directory / name
        if file.is_file():
            return str(file)
        vertices, faces = mesh.triangles()
        vertices = vertices * np.asarray(scale)
        if kind == 'hull':
            vertices, faces = _hull(vertices[np.unique(faces)])
        elif np.prod(np.sign(scale)) < 0.0:
            faces = faces[:, ::-1]  # a mirror turns the triangles inside out
        return self._keep(name, _obj(vertices, faces))

    def _keep(self, name: str, text: str) -> str:
        """Write a file, if need be into a temporary directory; return its path."""
        with self._lock:
            try:
                self._write(name, text)
            except OSError as error:
                if self._temporary is not None:
                    raise
                logger.warning(
                    'mesh cache %s cannot be written (%s); a temporary one is used',
                    self._directory, error.strerror,
                )
                self._use_temporary()
                self._write(name, text)
            return str(self._directory / name)

    def _write(self, name: str, text: str) -> None:
        """Write a file so that no other process ever sees a part of it."""
        handle, temporary = tempfile.mkstemp(dir=self._directory, suffix='.tmp')
        try:
            with os.fdopen(handle, 'w', encoding='ascii') as file:
                file.write(text)
            os.replace(temporary, self._directory / name)
        except BaseException:
            os.unlink(temporary)
            raise


def _hull(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return points that span nearly the hull of `points`, and triangles that use each of them."""
    points = np.unique(points, axis=0)
    if len(points) > HULL_DIRECTIONS:
        # Plain sums, one direction after the other: a matrix product would take gigabytes for a
        # large mesh, and of two points equally far each library would take another.
        x, y, z = points.T.copy()
        points = points[sorted({int(np.argmax(a * x + b * y + c * z))
                                for a, b, c in _directions().tolist()})]
    while len(points) < 3:
        points = np.concatenate([points, points[-1:]])
    first = np.arange(len(points) - 2)
    return points, np.stack([first, first + 1, first + 2], axis=1)


@lru_cache(maxsize=1)
def _directions() -> np.ndarray:
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


def _obj(vertices: np.ndarray, faces: np.ndarray) -> str:
    lines = ['o mesh']
    lines += ['v {:.9g} {:.9g} {:.9g}'.format(*vertex) for vertex in vertices.tolist()]
    lines += ['f {} {} {}'.format(*face) for face in (faces + 1).tolist()]
    return '\n'.join(lines) + '\n'
