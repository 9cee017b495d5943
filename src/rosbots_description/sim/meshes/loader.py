"""Read mesh files (.dae, .stl, .obj) into validated plain triangles.

Many malformed mesh files crash the physics engine, so it never gets the user's files. Units and
node transforms of a Collada file are applied; its up_axis is not, as neither RViz nor PyBullet
applies it, and visuals and physics must agree. Nothing here prints or uses the network.
"""

import hashlib
import logging
import os
import threading
import warnings
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ..core import MAX_LENGTH, AbsentError, Fault, ModelError, report, shortened
from ..core.arrays import FloatArray, IntArray
from ..description import Colour, Reflection
from ..resources import read_file, regular_state, within
from .collada_limits import ColladaError, safe_collada
from .decimation import decimated
from .obj import ObjPart, read_obj
from .stl import read_stl

if TYPE_CHECKING:
    from .collada import ColladaPart

MAX_MESH_BYTES = 120_000_000
MAX_TRIANGLES = 3_000_000  # in the file; a binary STL of 120 MB has 2.4 million
MAX_SIMULATED_TRIANGLES = 400_000  # a mesh with more is decimated
MAX_LIBRARY_BYTES = 1_000_000
FORMATS = ('.dae', '.stl', '.obj')

WHITE = Reflection()
GREY: Colour = (0.7, 0.7, 0.7, 1.0)

# A material this transparent is nearly always an exporter's mistake: the part is shown opaque.
_INVISIBLE = 0.01

# Warning filters are global to the process; two threads must not change them at the same time.
_SILENCE = threading.Lock()


@dataclass(frozen=True, eq=False)
class MeshPart:
    """Triangles of one colour."""

    vertices: FloatArray  # (n, 3) [m]
    faces: IntArray  # (m, 3), numbers of vertices
    normals: FloatArray | None  # (n, 3), unit vectors at the vertices
    rgba: Colour
    textured: bool = False  # it has a texture besides this colour
    reflection: Reflection = WHITE
    texcoords: FloatArray | None = None  # (n, 2), at the vertices
    image: str = ''  # path of what covers it


@dataclass(frozen=True, eq=False)
class MeshData:
    """A mesh file's content; `digest` identifies the file's bytes."""

    digest: str
    parts: tuple[MeshPart, ...]
    textured: bool = False  # whether any part is

    def triangles(self) -> tuple[FloatArray, IntArray]:
        """Return all parts as one: vertices (n, 3) [m] and faces (m, 3)."""
        starts = np.cumsum([0, *(len(part.vertices) for part in self.parts)])
        return (
            np.concatenate([part.vertices for part in self.parts]),
            np.concatenate(
                [part.faces + start for part, start in zip(self.parts, starts, strict=False)]
            ),
        )


def check_mesh(path: str, scale: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> None:
    """Check that a mesh file can be simulated and shown.

    The result is cached until the file changes.

    Args:
        scale: factors of x, y, z that it will be used with.
    Raises:
        ModelError: the message names the file and its fault.
    """
    reach = float(np.abs(mesh_ends(path)).max()) * max(map(abs, scale))
    if reach > MAX_LENGTH:
        raise _fault(path, f'reaches {reach:g} m far; at most {MAX_LENGTH:g} m are accepted')


def mesh_ends(path: str) -> FloatArray:
    """Return the lowest and the highest corner (2, 3) of the box around a mesh file [m].

    Those of thousands of files are remembered.

    Raises:
        ModelError: as `read_mesh`.
    """
    return _ends(str(path), *_state(path))


def read_mesh(path: str) -> MeshData:
    """Return the triangles of a mesh file, in parts by colour.

    Colours are the diffuse ones of Collada and of an .obj's .mtl; parts without one are grey.

    Raises:
        ModelError: the file is missing, of an unknown format, too big, broken or empty.
    """
    return _read(str(path), *_state(path))  # a plain string: caches hold no file


def load_readers() -> None:
    """Import the Collada reader in advance, so that the first file is not delayed."""
    from . import collada  # noqa: F401  as it says


def _state(path: str) -> tuple[int, int]:
    """Return modification time [ns] and size, to detect changes of a file."""
    if not os.path.exists(path):
        raise _fault(
            path, 'does not exist or cannot be reached; check name and package', AbsentError
        )
    state = regular_state(path, 'mesh file')
    return state.st_mtime_ns, state.st_size


@lru_cache(maxsize=4096)
def _ends(path: str, mtime_ns: int, size: int) -> FloatArray:
    parts = [part.vertices for part in _read(path, mtime_ns, size).parts]
    return np.array(
        [
            np.min([part.min(axis=0) for part in parts], axis=0),
            np.max([part.max(axis=0) for part in parts], axis=0),
        ]
    )


@lru_cache(maxsize=16)
def _read(path: str, mtime_ns: int, size: int) -> MeshData:
    extension = os.path.splitext(path)[1].lower()
    if extension not in FORMATS:
        raise _fault(path, f"format '{extension}' is not read; convert it to {', '.join(FORMATS)}")
    content = read_file(path, MAX_MESH_BYTES, 'mesh file')
    parts = _check_parts(path, _parse(path, extension, content))
    return MeshData(
        hashlib.sha256(content).hexdigest(),
        _by_colour(_decimate(path, parts)),
        any(part.textured for part in parts),
    )


def _fault(path: str, sentence: str, kind: type[ModelError] = ModelError) -> ModelError:
    return kind(f"mesh file '{path}' {sentence}")


def _parse(path: str, extension: str, content: bytes) -> list[MeshPart]:
    # Third-party parsers may raise anything on a broken file.
    try:
        with _SILENCE, warnings.catch_warnings(), np.errstate(all='ignore'):
            warnings.simplefilter('ignore')
            return _PARSERS[extension](content, path)
    except ColladaError as error:
        raise _fault(path, str(error)) from error
    except Exception as error:
        reason = shortened(str(error), 200) or type(error).__name__
        raise _fault(path, f'is broken or no {extension} file: {reason}') from error


def _parse_collada(content: bytes, path: str) -> list[MeshPart]:
    from .collada import read_collada

    parts, unit = read_collada(safe_collada(content))
    return [_collada_part(part, unit, path) for part in parts]


def _parse_obj(content: bytes, path: str) -> list[MeshPart]:
    folder = os.path.dirname(path)

    def read_library(name: str) -> str:
        """Return a file beside the mesh; no other path in an .obj is opened."""
        library = os.path.join(folder, name)
        if not within(library, folder):
            return ''
        try:
            return read_file(library, MAX_LIBRARY_BYTES).decode('utf-8', 'replace')
        except ModelError as error:
            report(Fault(f'{error}, which {path} names', logging.DEBUG))
            return ''

    return [_obj_part(part) for part in read_obj(content, read_library)]


def _obj_part(part: ObjPart) -> MeshPart:
    normals = part.normals
    if normals is not None:
        normals = _turn_normals(normals, np.eye(3), len(part.vertices))
    rgba = _colour(None if part.colour is None else np.append(part.colour, 1.0))
    return MeshPart(
        part.vertices, part.faces, normals, rgba, part.textured, Reflection(rgba[:3], rgba[:3])
    )


def _parse_stl(content: bytes, path: str) -> list[MeshPart]:
    corners = read_stl(content)
    faces = np.arange(3 * len(corners)).reshape(-1, 3)
    return [MeshPart(corners.reshape(-1, 3), faces, None, GREY)]


_PARSERS = {'.dae': _parse_collada, '.obj': _parse_obj, '.stl': _parse_stl}


def _collada_part(part: 'ColladaPart', unit: float, path: str) -> MeshPart:
    faces, normals = part.faces, part.normals
    linear, offset = part.matrix[:3, :3], part.matrix[:3, 3]
    vertices = (np.asarray(part.vertices, dtype=float) @ linear.T + offset) * unit
    if np.linalg.det(linear) < 0.0:
        faces = faces[:, ::-1]  # a reflection reverses the orientation of the triangles
    if normals is not None:
        normals = _turn_normals(np.asarray(normals, dtype=float), linear, len(vertices))
    texcoords = part.texcoords
    if texcoords is not None and not np.isfinite(texcoords).all():
        texcoords = None
    image = _image_file(part.image, path) if part.image and texcoords is not None else ''
    return MeshPart(
        vertices,
        faces,
        normals,
        _colour(part.rgba),
        part.textured,
        part.reflection,
        texcoords,
        image,
    )


def _image_file(name: str, path: str) -> str:
    """Return where an image is that a mesh file names: beside it, or in its model; else ''."""
    folder = os.path.dirname(path)
    model = os.path.dirname(folder)
    for place in (
        os.path.join(folder, name),
        os.path.join(model, 'materials', 'textures', os.path.basename(name)),
    ):
        if within(place, model) and os.path.isfile(place):
            return os.path.realpath(place)
    report(Fault(f"mesh file '{path}' names the image '{name}', which is not there"))
    return ''


def _turn_normals(normals: FloatArray, linear: FloatArray, count: int) -> FloatArray | None:
    """Return unit normals after the transform, or None if they are unusable."""
    if normals.shape != (count, 3) or abs(np.linalg.det(linear)) < 1e-300:
        return None
    normals = normals @ np.linalg.inv(linear)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    if not np.isfinite(length).all() or (length == 0.0).any():
        return None
    normals /= length
    return normals


def _colour(rgba: FloatArray | None) -> Colour:
    if rgba is None or rgba.shape != (4,) or not np.isfinite(rgba).all():
        return GREY
    red, green, blue, alpha = (float(value) for value in np.clip(rgba, 0.0, 1.0))
    return (red, green, blue, alpha if alpha > _INVISIBLE else 1.0)


def _check_parts(path: str, parts: list[MeshPart]) -> list[MeshPart]:
    parts = [part for part in parts if len(part.faces)]
    count = sum(len(part.faces) for part in parts)
    if count == 0:
        raise _fault(path, 'holds no triangles; export the mesh again, triangulated')
    if count > MAX_TRIANGLES:
        raise _fault(
            path, f'has {count} triangles; at most {MAX_TRIANGLES} are accepted: simplify it'
        )
    for part in parts:
        if part.faces.min() < 0 or part.faces.max() >= len(part.vertices):
            raise _fault(path, 'is broken: a triangle names a vertex that does not exist')
        if not np.isfinite(part.vertices).all():
            raise _fault(path, 'is broken: a coordinate is no finite number')
    return parts


def _decimate(path: str, parts: list[MeshPart]) -> list[MeshPart]:
    """Return the parts, decimated to the number of triangles that is simulated and shown."""
    count = sum(len(part.faces) for part in parts)
    if count <= MAX_SIMULATED_TRIANGLES:
        return parts
    thin, widest = [], 0.0
    for part in parts:
        most = max(1, MAX_SIMULATED_TRIANGLES * len(part.faces) // count)
        vertices, faces, kept, cell = decimated(part.vertices, part.faces, most)
        normals = None if part.normals is None else part.normals[kept]
        texcoords = None if part.texcoords is None else part.texcoords[kept]
        thin.append(
            replace(part, vertices=vertices, faces=faces, normals=normals, texcoords=texcoords)
        )
        widest = max(widest, cell)
    left = sum(len(part.faces) for part in thin)
    report(
        Fault(
            f"mesh file '{path}' has {count} triangles; it is decimated to {left}, "
            f'on a grid of {widest:.2g} m'
        )
    )
    return thin


def _by_colour(parts: list[MeshPart]) -> tuple[MeshPart, ...]:
    """Return the parts with equal colours merged, in order of first appearance."""
    groups: dict[tuple[Colour, Reflection, str], list[MeshPart]] = {}
    for part in parts:
        groups.setdefault((part.rgba, part.reflection, part.image), []).append(part)
    joined = []
    for group in groups.values():
        vertices, faces = MeshData('', tuple(group)).triangles()
        have_normals = all(part.normals is not None for part in group)
        normals = np.concatenate([part.normals for part in group]) if have_normals else None
        texcoords = np.concatenate([part.texcoords for part in group]) if group[0].image else None
        for array in (vertices, faces, normals, texcoords):
            if array is not None:
                array.setflags(write=False)  # the cached array is shared by all callers
        joined.append(
            replace(group[0], vertices=vertices, faces=faces, normals=normals, texcoords=texcoords)
        )
    return tuple(joined)
