"""Read the visible content of a Collada file: the triangles of its scene, node by node.

To be imported late: pycollada takes a tenth of the simulator's start, and is seldom needed.
"""

import io
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from collada import Collada
from collada.common import DaeError
from collada.material import Effect, Map
from collada.polylist import Polylist
from collada.scene import GeometryNode, Node
from collada.triangleset import TriangleSet

from ..core import Vector
from ..core.arrays import FloatArray, IntArray
from ..description import Reflection

_AMBIENT, _DIFFUSE, _BLACK = (0.4, 0.4, 0.4), (0.5, 0.5, 0.5), (0.0, 0.0, 0.0)


class ColladaPart(NamedTuple):
    """Triangles of one material of a node; no two triangles share vertices."""

    vertices: FloatArray  # (n, 3) in the file's unit, before the node's matrix
    faces: IntArray  # (m, 3), numbers of vertices
    normals: FloatArray | None  # (n, 3)
    matrix: FloatArray  # (4, 4), from the node's frame to the scene's
    rgba: FloatArray | None  # (4,), None without a material; white with an image
    textured: bool
    reflection: Reflection
    texcoords: FloatArray | None  # (n, 2)
    image: str  # that covers it, as the file names it; '' for none


def read_collada(content: bytes) -> tuple[list[ColladaPart], float]:
    """Return the parts of a Collada file, and the length of its unit [m].

    Broken parts are left out, as in RViz. If nothing is left, or the file is not Collada, the
    exceptions of pycollada are passed on.
    """
    file = Collada(io.BytesIO(content), ignore=[DaeError])
    parts = [part for node in file.scene.nodes for part in _shown_by(node, np.eye(4))]
    if not parts:
        Collada(io.BytesIO(content))
    unit = file.assetInfo.unitmeter
    return parts, 1.0 if unit is None else float(unit)


def _shown_by(node: object, matrix: FloatArray) -> Iterator[ColladaPart]:
    if isinstance(node, GeometryNode):
        effects = {one.symbol: one.target.effect for one in node.materials}
        for primitive in node.geometry.primitives:
            yield from _triangles(primitive, matrix, effects)
    elif isinstance(node, Node):
        for child in node.children or ():
            yield from _shown_by(child, matrix @ node.matrix)


def _triangles(
    primitive: object, matrix: FloatArray, effects: dict[str, Effect]
) -> Iterator[ColladaPart]:
    if isinstance(primitive, Polylist):
        primitive = primitive.triangleset()
    if not isinstance(primitive, TriangleSet) or primitive.vertex is None:
        return
    vertices = primitive.vertex[primitive.vertex_index].reshape(-1, 3)
    normals = None
    if primitive.normal is not None:
        normals = primitive.normal[primitive.normal_index].reshape(-1, 3)
    faces = np.arange(len(vertices)).reshape(-1, 3)
    texcoords = None
    if primitive.texcoordset:
        texcoords = primitive.texcoordset[0][primitive.texcoord_indexset[0]].reshape(-1, 2)
    effect = effects.get(primitive.material)
    yield ColladaPart(
        vertices,
        faces,
        normals,
        matrix,
        None if effect is None else _colour(effect),
        isinstance(getattr(effect, 'diffuse', None), Map),
        _reflection(effect),
        texcoords,
        _image(effect),
    )


def _reflection(effect: Effect | None) -> Reflection:
    """Return how a material answers to light; what it does not say is as in Gazebo."""

    def colour(name: str, default: Vector) -> Vector:
        given = getattr(effect, name, None)
        if not isinstance(given, tuple | list) or not np.isfinite(given[:3]).all():
            return default
        red, green, blue = (float(value) for value in np.clip(given[:3], 0.0, 1.0))
        return red, green, blue

    shininess = getattr(effect, 'shininess', None)
    return Reflection(
        colour('ambient', _AMBIENT),
        colour('diffuse', _DIFFUSE),
        colour('specular', _BLACK),
        float(shininess) if isinstance(shininess, float | int) else 0.0,
        colour('emission', _BLACK),
    )


def _image(effect: Effect | None) -> str:
    diffuse = getattr(effect, 'diffuse', None)
    return diffuse.sampler.surface.image.path or '' if isinstance(diffuse, Map) else ''


def _colour(effect: Effect) -> FloatArray:
    rgba = np.ones(4)
    if isinstance(effect.diffuse, tuple | list):
        rgba = np.array(effect.diffuse, dtype=float)
    if isinstance(effect.transparent, tuple | list):
        rgba = np.append(rgba[:3], float(effect.transparent[3]))
    return rgba
