"""Visuals as binary glTF 2.0, which browsers show.

Coordinates are those of the link, z up: what shows them must not turn them to glTF's y up.
"""

import io
import json
import math
import struct
from collections.abc import Iterator
from dataclasses import replace
from enum import Enum
from typing import Any, NamedTuple

import numpy as np
from PIL import Image

from ..core import Fault, ModelError, Vector, report
from ..core.arrays import FloatArray, IntArray
from ..description import Box, Colour, Cylinder, Material, Mesh, Plane, Reflection, Sphere, Visual
from ..meshes import MeshPart, read_mesh
from ..resources import read_file
from .shapes import unit_square
from .sunlit_meshes import UNIT_SURFACES

MAX_IMAGE_BYTES = 50_000_000
_FLOAT, _UNSIGNED_INT = 5126, 5125  # component types
_VERTICES, _INDICES = 34962, 34963  # targets of buffer views
_LINES, _TRIANGLES = 1, 4  # modes of primitives
_CLEAR = 0.35  # alpha of what is transparent, as a fraction of its own


class Look(Enum):
    """How visuals are drawn."""

    SOLID = 'solid'
    TRANSPARENT = 'transparent'
    WIREFRAME = 'wireframe'


class _Part(NamedTuple):
    """Triangles of one material, or lines; without normals they are shaded flat."""

    vertices: FloatArray  # (n, 3)
    faces: IntArray  # numbers of vertices: (m, 3), or (m, 2) of lines
    normals: FloatArray | None  # (n, 3)
    texcoords: FloatArray | None  # (n, 2), from the lower left corner of the image
    image: str  # path
    rgba: Colour
    reflection: Reflection


def visual_gltf(visual: Visual, look: Look = Look.SOLID) -> bytes:
    """Return a visual as a .glb file in the frame of the visual [m].

    Raises:
        ModelError: its mesh cannot be read.
    """
    parts, scale = _parts(visual)
    return _File(scale, [_drawn(part, look) for part in parts]).content()


def _parts(visual: Visual) -> tuple[list[_Part], Vector]:
    material = visual.material or Material()
    match visual.geometry:
        case Mesh(path, scale):
            return [_mesh_part(part, visual.material) for part in read_mesh(path).parts], scale
        case Plane(normal, (width, depth)):
            corners, scale = unit_square(normal), (width, depth, 1.0)
            surface = corners[:, :3], np.arange(len(corners)).reshape(-1, 3), corners[:, 3:6]
        case Box(size):
            surface, scale = UNIT_SURFACES[Box](), size
        case Sphere(radius):
            surface, scale = UNIT_SURFACES[Sphere](), (2.0 * radius, 2.0 * radius, 2.0 * radius)
        case Cylinder(radius, length):
            surface, scale = UNIT_SURFACES[Cylinder](), (2.0 * radius, 2.0 * radius, length)
    vertices, faces, normals = surface
    return [_Part(vertices, faces, normals, None, '', material.rgba, material.reflection)], scale


def _drawn(part: _Part, look: Look) -> _Part:
    if look is Look.TRANSPARENT:
        return part._replace(rgba=(*part.rgba[:3], _CLEAR * part.rgba[3]))
    if look is Look.WIREFRAME:
        edges = np.sort(part.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        return part._replace(
            faces=np.unique(edges, axis=0),
            normals=None,
            texcoords=None,
            image='',
            reflection=replace(part.reflection, lit=False),
        )
    return part


def _mesh_part(part: MeshPart, material: Material | None) -> _Part:
    rgba, reflection = (
        (part.rgba, part.reflection) if material is None else (material.rgba, material.reflection)
    )
    image = part.image if material is None and part.texcoords is not None else ''
    if image:
        rgba = (*reflection.diffuse, rgba[3])  # what the image is multiplied with
    return _Part(part.vertices, part.faces, part.normals, part.texcoords, image, rgba, reflection)


class _File:
    """Collects the parts of a .glb file."""

    def __init__(self, scale: Vector, parts: list[_Part]) -> None:
        self._data = bytearray()
        self._views: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []
        self._materials: list[dict[str, Any]] = []
        self._images: dict[str, int | None] = {}
        self._image_views: list[dict[str, Any]] = []
        primitives = [self._primitive(part) for part in parts]
        self._tree: dict[str, Any] = {
            'asset': {'version': '2.0'},
            'scene': 0,
            'scenes': [{'nodes': [0]}],
            'nodes': [{'mesh': 0, 'scale': list(map(float, scale))}],
            'meshes': [{'primitives': primitives}],
            'materials': self._materials,
            'accessors': self._accessors,
            'bufferViews': self._views,
            'buffers': [{'byteLength': len(self._data)}],
            'extensionsUsed': ['KHR_materials_unlit'],
        }
        if self._image_views:
            self._tree['images'] = self._image_views
            self._tree['textures'] = [{'source': i} for i in range(len(self._image_views))]

    def content(self) -> bytes:
        """Return the file: a header, the tree as JSON, and the arrays."""
        tree = json.dumps(self._tree).encode()
        tree += b' ' * (-len(tree) % 4)
        data = bytes(self._data)
        chunks = (
            struct.pack('<I', len(tree))
            + b'JSON'
            + tree
            + struct.pack('<I', len(data))
            + b'BIN\0'
            + data
        )
        return struct.pack('<4sII', b'glTF', 2, 12 + len(chunks)) + chunks

    def _primitive(self, part: _Part) -> dict[str, Any]:
        attributes = {'POSITION': self._array(part.vertices, 'VEC3')}
        if part.normals is not None:
            attributes['NORMAL'] = self._array(part.normals, 'VEC3')
        image = self._image(part.image) if part.image else None
        if image is not None and part.texcoords is not None:
            attributes['TEXCOORD_0'] = self._array(part.texcoords * (1, -1) + (0, 1), 'VEC2')
        self._materials.append(_material(part, image))
        return {
            'attributes': attributes,
            'indices': self._indices(part.faces),
            'mode': _TRIANGLES if part.faces.shape[1] == 3 else _LINES,
            'material': len(self._materials) - 1,
        }

    def _array(self, values: FloatArray, kind: str) -> int:
        array = np.asarray(values, '<f4')
        return self._accessor(
            {
                'bufferView': self._view(array.tobytes(), _VERTICES),
                'componentType': _FLOAT,
                'count': len(array),
                'type': kind,
                'min': array.min(axis=0).tolist(),
                'max': array.max(axis=0).tolist(),
            }
        )

    def _indices(self, faces: IntArray) -> int:
        return self._accessor(
            {
                'bufferView': self._view(faces.astype('<u4').tobytes(), _INDICES),
                'componentType': _UNSIGNED_INT,
                'count': faces.size,
                'type': 'SCALAR',
            }
        )

    def _accessor(self, accessor: dict[str, Any]) -> int:
        self._accessors.append(accessor)
        return len(self._accessors) - 1

    def _view(self, content: bytes, target: int | None = None) -> int:
        view = {'buffer': 0, 'byteOffset': len(self._data), 'byteLength': len(content)}
        self._views.append(view if target is None else view | {'target': target})
        self._data += content + bytes(-len(content) % 4)
        return len(self._views) - 1

    def _image(self, path: str) -> int | None:
        """Return the number of an image; None, with a warning, if it cannot be read."""
        if path not in self._images:
            try:
                kind, content = _browser_image(path)
            except (OSError, ValueError, ModelError, Image.DecompressionBombError) as error:
                report(Fault(f'texture {path} is not shown: {error}'))
                self._images[path] = None
            else:
                self._images[path] = len(self._image_views)
                self._image_views.append({'mimeType': kind, 'bufferView': self._view(content)})
        return self._images[path]


def _browser_image(path: str) -> tuple[str, bytes]:
    """Return an image's MIME type and content, as PNG if it is neither that nor JPEG."""
    content = read_file(path, MAX_IMAGE_BYTES, 'texture')
    with Image.open(io.BytesIO(content)) as image:
        if image.format in {'PNG', 'JPEG'}:
            return f'image/{image.format.lower()}', content
        converted = io.BytesIO()
        image.convert('RGBA').save(converted, 'PNG')
        return 'image/png', converted.getvalue()


def _material(part: _Part, image: int | None) -> dict[str, Any]:
    own, alpha = part.reflection, part.rgba[3]
    made: dict[str, Any] = {
        'pbrMetallicRoughness': {
            'baseColorFactor': [*_linear(part.rgba[:3]), float(alpha)],
            'metallicFactor': 0.0,
            'roughnessFactor': _roughness(own),
        },
        'emissiveFactor': list(_linear(own.emissive)),
        'doubleSided': own.both_sides,
    }
    if image is not None:
        made['pbrMetallicRoughness']['baseColorTexture'] = {'index': image}
    if alpha < 1.0:
        made['alphaMode'] = 'BLEND'
    if not own.lit:
        made['extensions'] = {'KHR_materials_unlit': {}}
    return made


def _roughness(own: Reflection) -> float:
    """Return the roughness whose highlight is as wide as that of the shininess (Phong)."""
    if not any(own.specular) or own.shininess <= 0.0:
        return 1.0
    return max(0.2, math.sqrt(math.sqrt(2.0 / (own.shininess + 2.0))))


def _linear(rgb: Vector) -> Iterator[float]:
    """Return a colour as linear light, from sRGB."""
    return (
        float(
            ((np.clip(c, 0.0, 1.0) + 0.055) / 1.055) ** 2.4 if c > 0.04045 else max(c, 0.0) / 12.92
        )
        for c in rgb
    )
