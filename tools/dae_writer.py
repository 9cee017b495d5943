"""Write coloured triangle surfaces as one Collada 1.4.1 file."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np
from mesh_shapes import Array, Surface, corner_normals
from numpy.typing import NDArray

_add = ElementTree.SubElement

NAMESPACE = 'http://www.collada.org/2005/11/COLLADASchema'
DATE = '2026-01-01T00:00:00Z'  # required by Collada; fixed for reproducible files


@dataclass(frozen=True)
class Colour:
    """Reflection of a part: red, green, blue and gloss, each in 0..1."""

    name: str
    rgb: tuple[float, float, float]
    gloss: float = 0.15


def collada(
    name: str,
    parts: Sequence[tuple[Colour, Surface]],
    up_axis: str = 'Z_UP',
    tool: str = 'tools/make_meshes.py',
) -> str:
    """Return the text of a Collada file with one mesh `name` in metres, joined by colour.

    `up_axis` is metadata for modelling tools: RViz, Gazebo and PyBullet do not
    rotate the mesh by it. `tool` is the script that made it.
    """
    surfaces: dict[Colour, list[Surface]] = {}
    for colour, surface in parts:
        surfaces.setdefault(colour, []).append(surface)
    joined = {colour: np.concatenate(several) for colour, several in surfaces.items()}

    root = ElementTree.Element('COLLADA', xmlns=NAMESPACE, version='1.4.1')
    asset = _add(root, 'asset')
    contributor = _add(asset, 'contributor')
    _add(contributor, 'authoring_tool').text = f'rosbots_description {tool}'
    _add(asset, 'created').text = DATE
    _add(asset, 'modified').text = DATE
    _add(asset, 'unit', name='meter', meter='1')
    _add(asset, 'up_axis').text = up_axis
    _add_colours(root, joined)
    geometry = _add(_add(root, 'library_geometries'), 'geometry', id=f'{name}-mesh', name=name)
    _add_mesh(geometry, name, joined)
    _add_scene(root, name, joined)
    ElementTree.indent(root, ' ')
    text = ElementTree.tostring(root, encoding='unicode')
    return f'<?xml version="1.0" encoding="utf-8"?>\n{text}\n'


def _add_colours(root: ElementTree.Element, colours: Iterable[Colour]) -> None:
    """Add an effect and a material for each colour."""
    effects = _add(root, 'library_effects')
    for colour in colours:
        effect = _add(effects, 'effect', id=f'{colour.name}-effect')
        profile = _add(effect, 'profile_COMMON')
        phong = _add(_add(profile, 'technique', sid='common'), 'phong')
        shine = (colour.gloss,) * 3
        for role, rgb in (('ambient', colour.rgb), ('diffuse', colour.rgb), ('specular', shine)):
            value = _add(_add(phong, role), 'color', sid=role)
            value.text = _numbers((*rgb, 1.0))
        _add(_add(phong, 'shininess'), 'float').text = '30'
    materials = _add(root, 'library_materials')
    for colour in colours:
        material = _add(materials, 'material', id=colour.name, name=colour.name)
        _add(material, 'instance_effect', url=f'#{colour.name}-effect')


def _add_mesh(geometry: ElementTree.Element, name: str, surfaces: dict[Colour, Surface]) -> None:
    """Add the points, the normals and, for each colour, the triangles."""
    mesh = _add(geometry, 'mesh')
    corners = np.concatenate(list(surfaces.values())).reshape(-1, 3)
    normals = np.concatenate([corner_normals(each) for each in surfaces.values()]).reshape(-1, 3)
    point_index = _add_source(mesh, f'{name}-points', corners)
    normal_index = _add_source(mesh, f'{name}-normals', normals)
    vertices = _add(mesh, 'vertices', id=f'{name}-vertices')
    _add(vertices, 'input', semantic='POSITION', source=f'#{name}-points')

    indices = np.column_stack([point_index, normal_index])
    start = 0
    for colour, surface in surfaces.items():
        triangles = _add(mesh, 'triangles', material=colour.name, count=str(len(surface)))
        _add(triangles, 'input', semantic='VERTEX', source=f'#{name}-vertices', offset='0')
        _add(triangles, 'input', semantic='NORMAL', source=f'#{name}-normals', offset='1')
        end = start + 3 * len(surface)
        _add(triangles, 'p').text = ' '.join(map(str, indices[start:end].ravel()))
        start = end


def _add_source(mesh: ElementTree.Element, identity: str, vectors: Array) -> NDArray[np.intp]:
    """Add each distinct vector once; return the index of every input vector."""
    rows, index = np.unique(np.round(vectors, 6) + 0.0, axis=0, return_inverse=True)
    source = _add(mesh, 'source', id=identity)
    array = _add(source, 'float_array', id=f'{identity}-array', count=str(rows.size))
    array.text = _numbers(rows.ravel())
    accessor = _add(
        _add(source, 'technique_common'),
        'accessor',
        source=f'#{identity}-array',
        count=str(len(rows)),
        stride='3',
    )
    for axis in 'XYZ':
        _add(accessor, 'param', name=axis, type='float')
    numbers: NDArray[np.intp] = index.reshape(-1)
    return numbers


def _add_scene(root: ElementTree.Element, name: str, colours: Iterable[Colour]) -> None:
    """Add the scene with a node for the mesh."""
    scenes = _add(root, 'library_visual_scenes')
    node = _add(_add(scenes, 'visual_scene', id='scene', name='scene'), 'node', id=name, name=name)
    instance = _add(node, 'instance_geometry', url=f'#{name}-mesh')
    technique = _add(_add(instance, 'bind_material'), 'technique_common')
    for colour in colours:
        _add(technique, 'instance_material', symbol=colour.name, target=f'#{colour.name}')
    _add(_add(root, 'scene'), 'instance_visual_scene', url='#scene')


def _numbers(values: Sequence[float]) -> str:
    """Write numbers with six significant digits."""
    return ' '.join(f'{value:.6g}' for value in values)
