"""Read Wavefront .obj files and the colours of their .mtl; polygons are triangulated.

The keywords v, vn, f, usemtl and mtllib are read; lines, curves, textures and groups are not.
"""

from array import array
from collections import defaultdict
from collections.abc import Callable
from io import BytesIO, TextIOWrapper
from itertools import repeat
from typing import NamedTuple

import numpy as np

from ..core.arrays import FloatArray, IntArray

MAX_LIBRARIES = 8  # .mtl files of one .obj
MAX_MATERIALS = 1000  # each a part of its own; parts with further materials have no colour

RGB = tuple[float, float, float]
ObjMaterial = tuple[RGB | None, bool]  # the colour of a material, and whether it has a texture
ReadLibrary = Callable[[str], str]  # the name of a .mtl file -> its text, '' if there is none


class ObjPart(NamedTuple):
    """The triangles of one material."""

    vertices: FloatArray  # (n, 3)
    faces: IntArray  # (m, 3), numbers of vertices
    normals: FloatArray | None  # (n, 3), as written
    colour: RGB | None  # red, green, blue in 0..1
    textured: bool


class _Faces:
    """The polygons of one material; indices count from 1."""

    def __init__(self) -> None:
        self.sizes = array('q')  # corners of each
        self.vertices = array('q')  # of each corner
        self.normals = array('q')  # of each corner, 0 where it has none

    def add(self, line: str, vertices: int, normals: int) -> None:
        """Add a face line, which follows `vertices` v lines and `normals` vn lines."""
        corners = line.split()
        self.sizes.append(len(corners))
        if '/' not in line and '-' not in line:  # the common case has a fast path
            self.vertices.extend(map(int, corners))
            self.normals.extend(repeat(0, len(corners)))
            return
        for corner in corners:
            numbers = [int(part or 0) for part in corner.split('/')]  # v, v/vt, v//vn or v/vt/vn
            self.vertices.append(_from_start(numbers[0], vertices))
            self.normals.append(_from_start(numbers[2], normals) if len(numbers) > 2 else 0)


def read_obj(content: bytes, read_library: ReadLibrary) -> list[ObjPart]:
    """Return the parts of an .obj file, one for each material in use.

    Raises:
        ValueError, IndexError, OverflowError: the file is broken.
    """
    # A file may have millions of lines: decode them one by one, and store numbers, not strings.
    lines = TextIOWrapper(
        BytesIO(content.replace(b'\\\n', b' ')), 'utf-8', errors='replace', newline='\n'
    )
    positions, normals = array('d'), array('d')
    groups: dict[str, _Faces] = defaultdict(_Faces)
    libraries: dict[str, None] = {}
    material = ''
    for line in lines:
        word, _, rest = line.strip().partition(' ')
        if word == 'v':
            positions.extend(_three(rest))
        elif word == 'vn':
            normals.extend(_three(rest))
        elif word == 'f':
            groups[material].add(rest, len(positions) // 3, len(normals) // 3)
        elif word == 'usemtl':
            material = rest.strip()
            if material not in groups and len(groups) >= MAX_MATERIALS:
                material = ''
        elif word == 'mtllib' and len(libraries) < MAX_LIBRARIES:
            libraries[rest.strip()] = None
    if not groups:
        return []
    points = np.asarray(positions).reshape(-1, 3)
    directions = np.asarray(normals).reshape(-1, 3)
    materials: dict[str, ObjMaterial] = {}
    for name in libraries:
        materials |= _read_materials(read_library(name))
    return [
        _part(faces, points, directions, materials.get(name, (None, False)))
        for name, faces in groups.items()
    ]


def _three(words: str) -> tuple[float, float, float]:
    x, y, z = map(float, words.split()[:3])
    return x, y, z


def _from_start(number: int, count: int) -> int:
    """Return an index that counts from 1; a negative one counts back from the last of `count`."""
    return count + 1 + number if -count <= number < 0 else number


def _part(
    faces: _Faces, points: FloatArray, directions: FloatArray, material: ObjMaterial
) -> ObjPart:
    corners = _fans(np.asarray(faces.sizes))
    vertices = _checked(np.asarray(faces.vertices), len(points))[corners]
    normals = np.asarray(faces.normals)[corners]
    if not len(directions) or not normals.all():
        used, triangles = _renumbered(vertices)
        return ObjPart(points[used - 1], triangles, None, *material)
    base = len(directions) + 1
    used, triangles = _renumbered(base * vertices + _checked(normals, len(directions)))
    return ObjPart(points[used // base - 1], triangles, directions[used % base - 1], *material)


def _renumbered(numbers: IntArray) -> tuple[IntArray, IntArray]:
    """Return the unique numbers, and for each number its index among them."""
    used = np.unique(numbers)
    return used, np.searchsorted(used, numbers)


def _checked(numbers: IntArray, count: int) -> IntArray:
    """Return the indices, which count from 1, if none exceeds `count`."""
    if len(numbers) and (numbers.min() < 1 or numbers.max() > count):
        wrong = numbers[(numbers < 1) | (numbers > count)][0]
        raise IndexError(f'a face names number {wrong} of {count}, which does not exist')
    return numbers


def _fans(sizes: IntArray) -> IntArray:
    """Return the triangles (n, 3) of polygons that have `sizes` corners each, corner by corner."""
    starts = np.cumsum(sizes) - sizes
    counts = np.maximum(sizes - 2, 0)
    first = np.repeat(starts, counts)
    step = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    return np.stack([first, first + step + 1, first + step + 2], axis=1)


def _read_materials(text: str) -> dict[str, ObjMaterial]:
    """Return the diffuse colour of each material of a .mtl file, and whether it has a texture."""
    materials: dict[str, ObjMaterial] = {}
    name = ''
    for line in text.splitlines():
        word, _, rest = line.strip().partition(' ')
        if word == 'newmtl':
            name = rest.strip()
        elif word == 'Kd':
            try:
                red, green, blue = map(float, rest.split()[:3])
            except ValueError:
                continue  # a spectral curve or invalid text: the part is grey
            materials[name] = (red, green, blue), materials.get(name, (None, False))[1]
        elif word == 'map_Kd':
            materials[name] = materials.get(name, (None, False))[0], True
    return materials
