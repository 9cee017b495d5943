"""Read Wavefront .obj files and the colours of their .mtl: polygons become triangles.

Read are v, vn, f, usemtl and mtllib; lines, curves, textures and groups are not.
"""

from array import array
from collections.abc import Callable
from dataclasses import dataclass, field
from io import StringIO
from typing import NamedTuple

import numpy as np

MAX_LIBRARIES = 8  # .mtl files of one .obj
MAX_MATERIALS = 1000  # each a part of its own; what uses yet another has no colour

Colour = tuple[float, float, float]
ReadLibrary = Callable[[str], str]  # the name of a .mtl file -> its text, '' if there is none


class ObjPart(NamedTuple):
    """The triangles of one material."""

    vertices: np.ndarray  # (n, 3)
    faces: np.ndarray  # (m, 3), numbers of vertices
    normals: np.ndarray | None  # (n, 3), as written
    colour: Colour | None  # red, green, blue in 0..1


@dataclass
class _Faces:
    """The f lines of one material, and how many v and vn lines stood before each."""

    lines: list[str] = field(default_factory=list)
    before: list[tuple[int, int]] = field(default_factory=list)


def read_obj(text: str, read_library: ReadLibrary) -> list[ObjPart]:
    """Return the parts of an .obj file, one for each material in use.

    Raises:
        ValueError, IndexError, OverflowError: the file is broken.
    """
    positions, normals = array('d'), array('d')  # compact: there may be millions
    groups: dict[str, _Faces] = {}
    libraries: dict[str, None] = {}
    material = ''
    for line in StringIO(text.replace('\\\n', ' ')):
        word, _, rest = line.strip().partition(' ')
        if word == 'v':
            positions.extend(_three(rest))
        elif word == 'vn':
            normals.extend(_three(rest))
        elif word == 'f':
            faces = groups.setdefault(material, _Faces())
            faces.lines.append(rest)
            faces.before.append((len(positions) // 3, len(normals) // 3))
        elif word == 'usemtl':
            material = rest.strip()
            if material not in groups and len(groups) >= MAX_MATERIALS:
                material = ''
        elif word == 'mtllib' and len(libraries) < MAX_LIBRARIES:
            libraries[rest.strip()] = None
    if not groups:
        return []
    points = np.array(positions).reshape(-1, 3)
    directions = np.array(normals).reshape(-1, 3)
    colours: dict[str, Colour] = {}
    for name in libraries:
        colours |= _read_colours(read_library(name))
    return [
        _part(faces, points, directions, colours.get(name)) for name, faces in groups.items()
    ]


def _three(words: str) -> tuple[float, float, float]:
    x, y, z = map(float, words.split()[:3])
    return x, y, z


def _part(
    faces: _Faces, points: np.ndarray, directions: np.ndarray, colour: Colour | None
) -> ObjPart:
    sizes = np.array([len(line.split()) for line in faces.lines])
    corners = _corners(' '.join(faces.lines))
    before = np.repeat(np.array(faces.before), sizes, axis=0)
    vertex = _from_start(corners[:, 0], before[:, 0], len(points))
    triangles = _fans(sizes)
    used = np.unique(triangles)
    if len(directions) and corners.shape[1] == 3 and corners[used, 2].all():
        normal = _from_start(corners[:, 2], before[:, 1], len(directions))
        pairs, number = np.unique(
            np.stack([vertex, normal], axis=1), axis=0, return_inverse=True
        )
        faces = number.reshape(-1)[triangles]
        return ObjPart(points[pairs[:, 0]], faces, directions[pairs[:, 1]], colour)
    numbers, number = np.unique(vertex, return_inverse=True)
    return ObjPart(points[numbers], number.reshape(-1)[triangles], None, colour)


def _corners(text: str) -> np.ndarray:
    """Return the corners `v`, `v/vt`, `v//vn` or `v/vt/vn` as numbers (n, 1, 2 or 3); 0: none."""
    words = text.split()
    columns = {word.count('/') + 1 for word in words}
    if len(columns) == 1 and '//' not in text and '/ ' not in text:
        numbers = np.array(text.replace('/', ' ').split(), dtype=np.int64)
        return numbers.reshape(len(words), *columns)
    rows = [[int(part or 0) for part in word.split('/')] for word in words]
    return np.array([(row + [0, 0])[:3] for row in rows], dtype=np.int64).reshape(-1, 3)


def _from_start(numbers: np.ndarray, before: np.ndarray, count: int) -> np.ndarray:
    """Return numbers counted from 0; a file counts from 1, or with -1 back from where it is."""
    found = np.where(numbers < 0, before + numbers, numbers - 1)
    if len(found) and (found.min() < 0 or found.max() >= count):
        wrong = numbers[(found < 0) | (found >= count)][0]
        raise IndexError(f'a face names number {wrong} of {count}, which does not exist')
    return found


def _fans(sizes: np.ndarray) -> np.ndarray:
    """Return the triangles (n, 3) of polygons that have `sizes` corners each, corner by corner."""
    starts = np.cumsum(sizes) - sizes
    counts = np.maximum(sizes - 2, 0)
    first = np.repeat(starts, counts)
    step = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    return np.stack([first, first + step + 1, first + step + 2], axis=1)


def _read_colours(text: str) -> dict[str, Colour]:
    """Return the diffuse colour of each material of a .mtl file that gives one."""
    colours: dict[str, Colour] = {}
    name = ''
    for line in text.splitlines():
        word, _, rest = line.strip().partition(' ')
        if word == 'newmtl':
            name = rest.strip()
        elif word == 'Kd':
            try:
                red, green, blue = map(float, rest.split()[:3])
            except ValueError:
                continue  # a spectral curve, or nonsense: the part is grey
            colours[name] = (red, green, blue)
    return colours
