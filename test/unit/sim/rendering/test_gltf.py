"""Visuals as glTF: their triangles, where they end, and how they look."""

import json
import struct

import numpy as np
import pytest
from PIL import Image

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.description import (
    Box,
    Cylinder,
    Material,
    Mesh,
    Plane,
    Reflection,
    Sphere,
    Visual,
    gazebo_material,
)
from rosbots_description.sim.meshes.loader import MeshData, MeshPart
from rosbots_description.sim.rendering import Look, gltf, visual_gltf


@pytest.fixture
def covered(tmp_path, monkeypatch):
    """A mesh of one triangle, covered by the image p.bmp."""
    part = MeshPart(
        np.array([(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.0, 1.0, 0.0)]),
        np.array([(0, 1, 2)]),
        None,
        (0.5, 0.5, 0.5, 1.0),
        texcoords=np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]),
        image=str(tmp_path / 'p.bmp'),
    )
    monkeypatch.setattr(gltf, 'read_mesh', lambda path: MeshData('', (part,)))
    return Mesh('m.dae', (1.0, 2.0, 1.0))


def read(geometry, material=None, look=Look.SOLID):
    """Return the tree and the arrays (function of an accessor's number) of a visual's file."""
    content = visual_gltf(Visual('v', geometry, material=material), look)
    magic, version, length, size = struct.unpack_from('<4sIII', content)
    assert (magic, version, length) == (b'glTF', 2, len(content))
    tree, data = json.loads(content[20 : 20 + size]), content[28 + size :]
    assert tree['buffers'] == [{'byteLength': len(data)}]

    def array(number):
        accessor = tree['accessors'][number]
        view = tree['bufferViews'][accessor['bufferView']]
        width = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3}[accessor['type']]
        kind = {5126: '<f4', 5125: '<u4'}[accessor['componentType']]
        found = np.frombuffer(data[view['byteOffset'] :][: view['byteLength']], kind)
        return found.reshape(accessor['count'], width)

    return tree, array


def corners(geometry):
    """Return the lowest and highest corner of what is drawn."""
    tree, array = read(geometry)
    points = np.concatenate(
        [
            array(primitive['attributes']['POSITION'])
            for primitive in tree['meshes'][0]['primitives']
        ]
    )
    points = points * tree['nodes'][0]['scale']
    return points.min(axis=0), points.max(axis=0)


@pytest.mark.parametrize(
    ('geometry', 'low', 'high'),
    [
        (Box((1.0, 2.0, 3.0)), (-0.5, -1.0, -1.5), (0.5, 1.0, 1.5)),
        (Sphere(0.5), (-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)),
        (Cylinder(0.2, 3.0), (-0.2, -0.2, -1.5), (0.2, 0.2, 1.5)),
        (Plane(size=(4.0, 6.0)), (-2.0, -3.0, 0.0), (2.0, 3.0, 0.0)),
    ],
)
def test_a_shape_has_its_size(geometry, low, high):
    np.testing.assert_allclose(corners(geometry), (low, high), atol=1e-6)


def test_a_mesh_is_scaled_and_its_image_covers_it_the_right_way_up(covered, tmp_path):
    Image.new('RGB', (2, 2), (255, 0, 0)).save(tmp_path / 'p.bmp')
    np.testing.assert_allclose(corners(covered), ((0, 0, 0), (2, 2, 0)))
    tree, array = read(covered)
    assert tree['images'][0]['mimeType'] == 'image/png'  # browsers cannot show every format
    attributes = tree['meshes'][0]['primitives'][0]['attributes']
    assert array(attributes['TEXCOORD_0'])[:, 1].tolist() == [1.0, 1.0, 0.0]
    assert 'NORMAL' not in attributes  # flat
    assert tree['materials'][0]['pbrMetallicRoughness']['baseColorFactor'] == [1.0] * 4
    # Another material takes the image's place.
    tree, _ = read(covered, Material.plain((0.0, 1.0, 0.0, 1.0)))
    assert 'images' not in tree


def test_a_mesh_whose_image_cannot_be_read_is_shown_without(covered, tmp_path, caplog):
    (tmp_path / 'p.bmp').write_text('not an image')
    assert 'images' not in read(covered)[0]
    assert 'p.bmp is not shown' in caplog.text


def test_colours_are_linear_and_what_glows_or_shines_through_does():
    tree, _ = read(
        Sphere(1.0),
        Material((0.5, 0.0, 1.0, 0.25), reflection=Reflection(emissive=(1.0, 0.0, 0.0), lit=False)),
    )
    (material,) = tree['materials']
    # sRGB 0.5 is 0.214 of the light
    assert material['pbrMetallicRoughness']['baseColorFactor'] == pytest.approx(
        [0.2140, 0.0, 1.0, 0.25], abs=1e-4
    )
    assert material['emissiveFactor'] == [1.0, 0.0, 0.0]
    assert material['alphaMode'] == 'BLEND'
    assert 'KHR_materials_unlit' in material['extensions']


def test_what_is_transparent_keeps_its_colour_and_image(covered, tmp_path):
    Image.new('RGB', (2, 2)).save(tmp_path / 'p.bmp')
    tree, _ = read(covered, look=Look.TRANSPARENT)
    (material,) = tree['materials']
    assert material['alphaMode'] == 'BLEND'
    assert material['pbrMetallicRoughness']['baseColorFactor'][3] == pytest.approx(0.35)
    assert 'baseColorTexture' in material['pbrMetallicRoughness']


def test_a_wireframe_has_each_edge_once():
    tree, array = read(Box((1.0, 2.0, 3.0)), look=Look.WIREFRAME)
    (primitive,) = tree['meshes'][0]['primitives']
    assert primitive['mode'] == 1  # lines
    assert set(primitive['attributes']) == {'POSITION'}
    points, ends = array(primitive['attributes']['POSITION']), array(primitive['indices'])
    lines = [tuple(sorted((tuple(points[a]), tuple(points[b])))) for a, b in ends.reshape(-1, 2)]
    assert len({tuple(sorted(line)) for line in ends.reshape(-1, 2).tolist()}) == len(lines)
    along = [line for line in set(lines) if sum(a != b for a, b in zip(*line, strict=True)) == 1]
    assert len(along) == 12  # the others are diagonals of its sides
    assert 'KHR_materials_unlit' in tree['materials'][0]['extensions']


def test_what_shines_is_smoother_than_what_does_not():
    rough = [
        read(Sphere(1.0), gazebo_material(name))[0]['materials'][0]['pbrMetallicRoughness'][
            'roughnessFactor'
        ]
        for name in ('Gazebo/Yellow', 'Gazebo/Red', 'Gazebo/White')
    ]
    assert rough == sorted(rough, reverse=True)
    assert rough[0] == 1.0
    assert rough[2] < rough[1]


def test_a_mesh_that_is_gone_is_refused(tmp_path):
    with pytest.raises(ModelError, match=r'gone\.stl'):
        visual_gltf(Visual('v', Mesh(str(tmp_path / 'gone.stl'))))
