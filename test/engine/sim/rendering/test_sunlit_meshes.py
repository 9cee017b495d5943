"""Mesh files for the window: Ogre's format, colours, and outward normals."""

import os
import re
import struct
from pathlib import Path

import numpy as np
import pytest
from support import ROOT

from rosbots_description.sim.description.model_spec import (
    Box,
    Cylinder,
    Material,
    Mesh,
    Plane,
    Sphere,
    Visual,
)
from rosbots_description.sim.rendering.sunlit_meshes import (
    OPAQUE,
    RECENT,
    TRANSPARENT,
    SunlitMeshes,
)

RED, GLASS = Material((1.0, 0.2, 0.0, 1.0)), Material((0.0, 0.0, 1.0, 0.4))
TWO_COLOURS = """mtllib m.mtl
v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 2
usemtl red\nf 1 2 3\nusemtl blue\nf 1 2 4
"""


@pytest.fixture
def meshes():
    return SunlitMeshes()


@pytest.fixture
def obj(tmp_path):
    def write(library):
        (tmp_path / 'm.mtl').write_text(library)
        (tmp_path / 'm.obj').write_text(TWO_COLOURS)
        return str(tmp_path / 'm.obj')

    return write


def chunks(data):
    """Yield id and content of each chunk of `data`."""
    while data:
        number, length = struct.unpack_from('<HI', data)
        assert 6 <= length <= len(data)
        yield number, data[6:length]
        data = data[length:]


def submeshes(path):
    """Yield material, corners (n, 3, 3), normals (n, 3, 3) and colours (n, 3, 4) of triangles."""
    data = Path(path).read_bytes()
    head = struct.pack('<H', 0x1000) + b'[MeshSerializer_v1.100]\n'
    assert data.startswith(head)
    ((number, mesh),) = chunks(data[len(head) :])
    assert (number, mesh[0]) == (0x3000, 0)
    for number, content in chunks(mesh[1:]):
        if number == 0x9000:
            continue
        assert number == 0x4000
        material, rest = content.split(b'\n', 1)
        shared, count, wide = struct.unpack_from('<?I?', rest)
        assert (shared, wide) == (False, True)
        faces = np.frombuffer(rest, '<u4', count, 6).reshape(-1, 3)
        (_, geometry), (_, operation) = chunks(rest[6 + 4 * count :])
        assert operation == struct.pack('<H', 4)
        (vertices,) = struct.unpack_from('<I', geometry)
        (_, elements), (_, buffer) = chunks(geometry[4:])
        assert [struct.unpack('<5H', one)[1:4] for _, one in chunks(elements)] == [
            (2, 1, 0),
            (2, 4, 12),
            (11, 5, 24),
        ]
        ((_, rows),) = chunks(buffer[4:])
        table = np.frombuffer(rows, [('p', '<f4', 3), ('n', '<f4', 3), ('c', 'u1', 4)])
        assert len(table) == vertices
        yield material.decode(), *(table[name][faces].astype(float) for name in 'pnc')


@pytest.mark.parametrize(
    ('geometry', 'area'),
    [(Box((1.0, 2.0, 3.0)), 6.0), (Cylinder(0.5, 2.0), 1.5 * np.pi), (Sphere(3.0), np.pi)],
)
def test_unit_shape_has_outward_faces_and_normals(meshes, geometry, area):
    ((material, corners, normals, colours),) = submeshes(
        meshes.file(Visual('v', geometry, material=RED))
    )
    assert material == 'rosbots/sunlit'
    assert (colours == (255, 51, 0, 255)).all()
    assert corners.max() == 0.5
    assert corners.min() == -0.5
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.linalg.norm(across, axis=1).sum() / 2.0 == pytest.approx(area, rel=0.01)
    assert np.linalg.norm(normals, axis=2) == pytest.approx(1.0, abs=1e-6)
    real = np.linalg.norm(across, axis=1) > 1e-9  # degenerate at the poles of a sphere
    middles = corners.mean(axis=1)
    assert (np.einsum('ij,ij->i', across, middles)[real] > 0.0).all()
    assert (np.einsum('ij,ikj->ik', across, normals)[real] > 0.0).all()


def test_materials_are_those_exported_to_rviz():
    file = ROOT / 'companions' / 'rosbots_simulator' / 'ogre_media' / 'sunlit.material'
    defined = re.findall(r'^material (\S+)', file.read_text(), re.M)
    assert defined == [OPAQUE.decode(), TRANSPARENT.decode()]


def test_transparent_mesh_has_the_transparent_material(meshes):
    ((material, _, _, colours),) = submeshes(meshes.file(Visual('v', Sphere(1.0), material=GLASS)))
    assert material == 'rosbots/sunlit_transparent'
    assert colours[0, 0].tolist() == [0, 0, 255, 102]


def test_mesh_keeps_its_colours_and_gets_missing_normals(meshes, obj):
    red, blue = submeshes(
        meshes.file(Visual('v', Mesh(obj('newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n'))))
    )
    assert [part[3][0, 0].tolist() for part in (red, blue)] == [[255, 0, 0, 255], [0, 0, 255, 255]]
    assert red[1][0].tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    assert red[2][0].tolist() == [[0, 0, 1]] * 3
    assert blue[2][0].tolist() == [[0, -1, 0]] * 3


def test_textured_mesh_is_left_to_rviz_unless_a_material_replaces_it(meshes, obj):
    path = obj('newmtl red\nKd 1 0 0\nnewmtl blue\nmap_Kd wood.png\nKd 0 0 1\n')
    assert meshes.file(Visual('v', Mesh(path))) is None
    assert meshes.file(Visual('v', Mesh(path), material=RED)) is not None


def test_planes_and_unreadable_meshes_have_no_file(meshes, tmp_path, caplog):
    assert meshes.file(Visual('v', Plane())) is None
    assert caplog.text == ''
    assert meshes.file(Visual('v', Mesh(str(tmp_path / 'gone.stl')))) is None
    assert "visual 'v' is lit from the eye" in caplog.text


def test_file_is_shared_and_removed_some_time_after_its_last_use(meshes):
    first = meshes.file(Visual('a', Box((1.0, 1.0, 1.0)), material=RED))
    path = str(first)
    assert meshes.file(Visual('b', Box((5.0, 1.0, 1.0)), material=RED)) == path
    del first
    assert os.path.isfile(path)
    for number in range(RECENT):
        meshes.file(Visual('c', Box((1.0, 1.0, 1.0)), material=Material((0, 0, number / 255, 1))))
    assert not os.path.exists(path)
