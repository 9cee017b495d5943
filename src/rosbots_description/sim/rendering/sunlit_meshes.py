"""Visuals as Ogre mesh files, which RViz shows lit by a sun.

RViz has a single light, at the camera, and markers cannot add another. But RViz finds the materials
of an Ogre mesh file by name, and `ogre_media` of the package rosbots_simulator defines ours. Their
vertex program applies a directional light that is fixed in the world, independent of the pose of
body and camera.
"""

import hashlib
import struct
from collections import deque
from collections.abc import Iterator, Sequence
from functools import cache

import numpy as np

from ..core import Fault, ModelError, report
from ..core.arrays import FloatArray, IntArray
from ..description import Box, Colour, Cylinder, Material, Mesh, Sphere, Visual
from ..meshes import read_mesh
from ..resources import SharedFile, SharedFiles

RECENT = 32  # files kept a while: RViz may read one after its model was deleted

OPAQUE, TRANSPARENT = b'rosbots/sunlit', b'rosbots/sunlit_transparent'  # as in ogre_media
SEGMENTS = 48  # around round shapes

# Vertices (n, 3), faces (m, 3) counter-clockwise, normals (n, 3).
Surface = tuple[FloatArray, IntArray, FloatArray]


class SunlitMeshes:
    """Writes the mesh files; each exists as long as it is referenced. Thread-safe."""

    def __init__(self) -> None:
        self._files = SharedFiles('rosbots_sunlit_')
        self._recent: deque[SharedFile] = deque(maxlen=RECENT)

    def file(self, visual: Visual) -> SharedFile | None:
        """Return the file of a visual, of unit size except for meshes, or None.

        There are no files for planes, which need no light, and for textures, which need RViz's own
        materials.
        """
        try:
            described = _description(visual)
            if described is None:
                return None
            name = f'{hashlib.sha256(repr(described).encode()).hexdigest()[:32]}.mesh'
            file = self._files.get(name) or self._files.write(
                name, ogre_mesh(list(_parts(visual))), getattr(visual.geometry, 'path', name)
            )
            self._recent.append(file)
            return file
        except ModelError as error:
            report(Fault(f"visual '{visual.name}' is lit from the eye: {error}"))
            return None


def ogre_mesh(parts: list[tuple[Surface, Colour]]) -> bytes:
    """Return an Ogre mesh file of surfaces, each of one colour."""
    corners = np.concatenate([vertices for (vertices, _, _), _ in parts])
    bounds = struct.pack(
        '<7f', *corners.min(axis=0), *corners.max(axis=0), np.linalg.norm(corners, axis=1).max()
    )
    submeshes = [_submesh(surface, rgba) for surface, rgba in parts]
    return (
        struct.pack('<H', 0x1000)
        + b'[MeshSerializer_v1.100]\n'
        + _chunk(0x3000, struct.pack('<?', False), *submeshes, _chunk(0x9000, bounds))
    )


# Vertex format of the file: name, numpy type, Ogre's type and semantic.
_ELEMENTS = (('position', '3<f4', 2, 1), ('normal', '3<f4', 2, 4), ('rgba', '4u1', 11, 5))
_VERTEX = np.dtype([(name, kind) for name, kind, _, _ in _ELEMENTS])
_OFFSETS = {name: offset for name, (_, offset, *_) in (_VERTEX.fields or {}).items()}
_TRIANGLE_LIST = 4


def _submesh(surface: Surface, rgba: Colour) -> bytes:
    vertices, faces, normals = surface
    data = np.empty(len(vertices), _VERTEX)
    data['position'], data['normal'] = vertices, normals
    data['rgba'] = np.round(255.0 * np.clip(rgba, 0.0, 1.0))
    elements = [
        _chunk(0x5110, struct.pack('<5H', 0, kind, meaning, _OFFSETS[name], 0))
        for name, _, kind, meaning in _ELEMENTS
    ]
    geometry = _chunk(
        0x5000,
        struct.pack('<I', len(vertices)),
        _chunk(0x5100, *elements),
        _chunk(0x5200, struct.pack('<2H', 0, _VERTEX.itemsize), _chunk(0x5210, data.tobytes())),
    )
    return _chunk(
        0x4000,
        OPAQUE if rgba[3] >= 1.0 else TRANSPARENT,
        b'\n',
        struct.pack('<?I?', False, faces.size, True),
        faces.astype('<u4').tobytes(),
        geometry,
        _chunk(0x4010, struct.pack('<H', _TRIANGLE_LIST)),
    )


def _chunk(number: int, *contents: bytes) -> bytes:
    content = b''.join(contents)
    return struct.pack('<HI', number, len(content) + 6) + content


def _description(visual: Visual) -> object:
    """Return a key for the contents of the file; None if there is no file."""
    match visual.geometry:
        case Mesh(path):
            mesh = read_mesh(path)
            return (mesh.digest, visual.material) if visual.material or not mesh.textured else None
        case Box() | Cylinder() | Sphere():
            return type(visual.geometry).__name__, visual.material
    return None


def _parts(visual: Visual) -> Iterator[tuple[Surface, Colour]]:
    if isinstance(visual.geometry, Mesh):
        for part in read_mesh(visual.geometry.path).parts:
            surface = (
                _flat(part.vertices[part.faces])
                if part.normals is None
                else (part.vertices, part.faces, part.normals)
            )
            yield surface, visual.material.rgba if visual.material else part.rgba
    else:
        yield UNIT_SURFACES[type(visual.geometry)](), (visual.material or Material()).rgba


def _flat(corners: FloatArray) -> Surface:
    """Return triangles (n, 3, 3) as a flat-shaded surface."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    return (
        corners.reshape(-1, 3),
        np.arange(3 * len(corners)).reshape(-1, 3),
        np.repeat(normals, 3, axis=0),
    )


@cache
def _box() -> Surface:
    square = np.array([(1, -1, -1), (1, 1, -1), (1, 1, 1), (1, -1, -1), (1, 1, 1), (1, -1, 1)]) / 2
    # The side at +x, and its copy at -x, rotated by 180 degrees about z.
    sides = np.stack([square, square * (-1, -1, 1)])
    return _flat(np.concatenate([np.roll(sides, k, axis=2) for k in range(3)]).reshape(-1, 3, 3))


@cache
def _cylinder() -> Surface:
    return _revolved(
        [
            [(0.0, -0.5, 0.0, -1.0), (0.5, -0.5, 0.0, -1.0)],
            [(0.5, -0.5, 1.0, 0.0), (0.5, 0.5, 1.0, 0.0)],
            [(0.5, 0.5, 0.0, 1.0), (0.0, 0.5, 0.0, 1.0)],
        ]
    )


@cache
def _sphere() -> Surface:
    latitudes = np.linspace(-np.pi / 2.0, np.pi / 2.0, SEGMENTS // 2 + 1)
    outward = np.stack([np.cos(latitudes), np.sin(latitudes)], axis=1)
    return _revolved([np.concatenate([outward / 2.0, outward], axis=1)])


UNIT_SURFACES = {Box: _box, Cylinder: _cylinder, Sphere: _sphere}


def _revolved(profile: Sequence[FloatArray | list[tuple[float, ...]]]) -> Surface:
    """Return the surface of revolution of a profile about z.

    Args:
        profile: strips of points (radius, z, normal's radius, normal's z), from the lowest.
    """
    angles = np.linspace(0.0, 2.0 * np.pi, SEGMENTS + 1)
    about = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    vertices: list[FloatArray] = []
    normals: list[FloatArray] = []
    faces: list[IntArray] = []
    first = 0
    j = np.arange(SEGMENTS)
    for strip in map(np.asarray, profile):
        for radial, vertical, into in ((0, 1, vertices), (2, 3, normals)):
            ring = strip[:, None, radial, None] * about
            height = np.broadcast_to(strip[:, None, vertical, None], (*ring.shape[:2], 1))
            into.append(np.concatenate([ring, height], axis=2).reshape(-1, 3))
        for i in range(len(strip) - 1):
            a = first + i * len(angles) + j
            c = a + len(angles)
            faces += [np.stack([a, a + 1, c + 1], axis=1), np.stack([a, c + 1, c], axis=1)]
        first += len(vertices[-1])
    return np.concatenate(vertices), np.concatenate(faces), np.concatenate(normals)
