"""Mesh files: read like RViz, rejected if invalid, converted for the engine."""

import math
import os
import shutil
import struct
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from support.collada import SCENE, VERTICES, collada
from support.programs import python
from support.refusals import sentence_of

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.description import Mesh
from rosbots_description.sim.meshes import engine_files, loader
from rosbots_description.sim.meshes.engine_files import HULL_DIRECTIONS, EngineFiles
from rosbots_description.sim.meshes.loader import GREY, check_mesh, read_mesh
from rosbots_description.sim.meshes.stl import read_stl

TRIANGLE = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n'
ASCII_STL = (
    'solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n'
    'endloop\nendfacet\nendsolid s\n'
)
BINARY_STL = b' ' * 80 + struct.pack('<I12fH', 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)


@pytest.fixture
def write(tmp_path):
    def write_file(name, content):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return str(path)

    return write_file


@pytest.fixture
def files():
    made = EngineFiles()
    yield made
    made.close()


def hull_file(files, path, scale=(1.0, 1.0, 1.0)):
    return files.engine_file(Mesh(path, scale), exact=False)


def corners(path):
    vertices, faces = read_mesh(path).triangles()
    return vertices[faces[0]].tolist()


@pytest.mark.parametrize(
    ('name', 'content'),
    [
        ('m.obj', TRIANGLE),
        ('M.OBJ', TRIANGLE),
        ('m.stl', ASCII_STL),
        ('M.STL', BINARY_STL),
        ('m.dae', collada()),
        ('M.DAE', collada()),
        ('y.dae', collada(up='Y_UP')),
        ('quad.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 1\nf 1 2 3\nf 1 2 3 4\n'),
        ('negative.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n'),
    ],
)
def test_each_format_gives_the_same_triangle(write, name, content):
    assert corners(write(name, content)) == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_collada_reader_is_imported_on_request_only():
    program = (
        'import sys; from rosbots_description.sim.meshes import loader; '
        "before = 'collada' in sys.modules; loader.load_readers(); "
        "sys.exit(before or 'collada' not in sys.modules)"
    )
    assert python(program).returncode == 0


def test_unit_and_node_transform_of_a_collada_file_are_applied(write):
    path = write('m.dae', collada(unit='0.01', matrix='2 0 0 10 0 1 0 20 0 0 1 30 0 0 0 1'))
    np.testing.assert_allclose(corners(path), [[0.1, 0.2, 0.3], [0.12, 0.2, 0.3], [0.1, 0.21, 0.3]])


def test_identifiers_with_markup_are_accepted_as_in_gazebo(write):
    strange = collada().replace('"g"', '"<STL_BINARY>"').replace('#g"', '#<STL_BINARY>"')
    assert corners(write('strange.dae', strange)) == corners(write('plain.dae', collada()))


def test_mirroring_node_keeps_faces_outward(write):
    path = write('m.dae', collada(matrix='-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1'))
    a, b, c = np.array(corners(path))
    assert np.cross(b - a, c - a)[2] > 0.0


def test_colour_of_a_collada_material_is_read(write):
    (part,) = read_mesh(write('m.dae', collada())).parts
    assert part.vertices.shape == (3, 3)
    assert part.faces.shape == (1, 3)
    assert part.rgba == pytest.approx((0.2, 0.4, 0.6, 1.0), abs=0.005)


def test_use_of_a_texture_is_detected(write):
    picture = (
        '<library_images><image id="i"><init_from>i.png</init_from></image></library_images>'
        '<library_effects>'
    )
    parameters = (
        '<newparam sid="s"><surface type="2D"><init_from>i</init_from></surface>'
        '</newparam><newparam sid="r"><sampler2D><source>s</source></sampler2D>'
        '</newparam><technique sid="t">'
    )
    textured = (
        collada()
        .replace('<library_effects>', picture)
        .replace('<technique sid="t">', parameters)
        .replace('<color>0.2 0.4 0.6 1</color>', '<texture texture="r" texcoord="UV"/>')
    )
    assert read_mesh(write('textured.dae', textured)).textured
    assert not read_mesh(write('m.dae', collada())).textured
    write(
        'm.mtl',
        'newmtl a\nmap_Kd i.png\nKd 1 0 0\nnewmtl b\nKd 1 0 0\nmap_Kd i.png\nnewmtl c\nKd 1 0 0\n',
    )
    for material, expected in (('a', True), ('b', True), ('c', False)):
        path = write(f'{material}.obj', f'mtllib m.mtl\nusemtl {material}\n{TRIANGLE}')
        assert read_mesh(path).textured is expected
        assert read_mesh(path).parts[0].rgba == (1, 0, 0, 1)


def test_obj_has_a_part_for_each_material_grey_without_one(write):
    write('m.mtl', 'newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n')
    path = write(
        'm.obj',
        'mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n'
        'usemtl red\nf 1 2 3\nusemtl blue\nf 1 2 4\n',
    )
    assert {part.rgba for part in read_mesh(path).parts} == {(1, 0, 0, 1), (0, 0, 1, 1)}
    assert read_mesh(write('plain.obj', TRIANGLE)).parts[0].rgba == GREY


def error_message(path):
    sentence = sentence_of(ModelError, check_mesh, path)
    assert sentence.startswith(f"mesh file '{path}' ")
    return sentence


BROKEN = {
    'a.dae': collada().replace('<p>0 1 2</p>', ''),
    'b.dae': collada().replace(VERTICES, ''),
    'c.dae': collada(index='0 1 1000000'),
    'c2.dae': collada(index='0 1 3'),
    'd.dae': collada(points='0 0 0 NaN 0 0 0 1 0'),
    'd2.dae': collada(points='0 0 0 inf 0 0 0 1 0'),
    'e.dae': collada(points=''),
    'f.dae': collada().replace(SCENE, ''),
    'g.dae': collada()[:700],
    'h.dae': 'PK\x03\x04',
    'i.dae': '',
    'j.dae': '<html/>',
    'k.dae': collada(points='0 0 x 1 0 0 0 1 0'),
    'a.obj': 'f 1 2 3\n',
    'b.obj': 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 1000000000\n',
    'c.obj': 'v 0 0 0\nv 1 0 0\nf 1 2\n',
    'd.obj': 'v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n',
    'e.obj': 'v 0 0 0\nv 1 0 0\nv 0 1 0\n',
    'f.obj': b'\x00\xff\xfe\x01',
    'g.obj': '',
    'h.obj': 'v 0 0 inf\nv 1 0 0\nv 0 1 0\nf 1 2 3\n',
    'a.stl': 'solid s\nendsolid s\n',
    'b.stl': BINARY_STL[:100],
    'c.stl': ASCII_STL.replace('vertex 1 0 0', 'vertex nan 0 0'),
    'd.stl': '',
    'e.stl': b' ' * 80 + struct.pack('<I', 0),
    'f.stl': b' ' * 80 + struct.pack('<I', 4_000_000_000),
}


@pytest.mark.parametrize('name', BROKEN)
def test_error_names_an_invalid_file(write, name):
    sentence = error_message(write(name, BROKEN[name]))
    assert 'is broken' in sentence or 'holds no triangles' in sentence


def test_normals_that_are_not_finite_are_accepted(write):
    normals = (
        '<source id="n"><float_array id="na" count="3">NaN NaN NaN</float_array>'
        '<technique_common><accessor source="#na" count="1" stride="3">'
        '<param name="X" type="float"/><param name="Y" type="float"/>'
        '<param name="Z" type="float"/></accessor></technique_common></source>'
    )
    check_mesh(write('m.dae', collada().replace(VERTICES, normals + VERTICES)))


def test_error_names_a_missing_file(tmp_path):
    assert 'does not exist' in error_message(str(tmp_path / 'no.dae'))


def test_folder_is_rejected(tmp_path):
    (tmp_path / 'm.dae').mkdir()
    assert 'is no file' in error_message(str(tmp_path / 'm.dae'))


def test_name_with_a_null_character_is_rejected():
    with pytest.raises(ModelError, match='does not exist'):
        check_mesh('/a\0.dae')


def test_error_about_an_unknown_format_lists_the_known_ones(write):
    sentence = error_message(write('m.glb', ''))
    assert "format '.glb' is not read; convert it to .dae, .stl, .obj" in sentence


def test_too_large_or_too_fine_file_is_rejected(write, monkeypatch):
    monkeypatch.setattr(loader, 'MAX_MESH_BYTES', 10)
    assert 'at most 10 are accepted' in error_message(write('a.obj', TRIANGLE))
    monkeypatch.undo()
    monkeypatch.setattr(loader, 'MAX_TRIANGLES', 1)
    assert 'has 2 triangles; at most 1' in error_message(write('b.obj', TRIANGLE + 'f 3 2 1\n'))


def test_corrected_file_is_read_again(write):
    path = write('m.obj', 'f 1 2 3\n')
    error_message(path)
    write('m.obj', TRIANGLE)
    check_mesh(path)


def test_nothing_is_printed_about_unusual_files(write, capfd, caplog, recwarn):
    path = write('m.obj', 'mtllib gone.mtl\nusemtl red\n' + TRIANGLE)
    check_mesh(path)
    error_message(write('n.stl', ASCII_STL.replace('vertex 1 0 0', 'vertex 1 x 0')))
    error_message(write('p.dae', '<COLLADA/>'))
    assert capfd.readouterr() == ('', '')
    assert caplog.text == ''
    assert len(recwarn) == 0


def read_obj(path):
    rows = [line.split() for line in Path(path).read_text(encoding='ascii').splitlines()]
    points = np.array([[float(x) for x in row[1:]] for row in rows if row[0] == 'v'])
    faces = np.array([[int(x) - 1 for x in row[1:]] for row in rows if row[0] == 'f'])
    return points, faces


def read_hull(path):
    """Return the vertices of a hull's file (n, 3) [m]."""
    return np.unique(read_stl(Path(path).read_bytes()).reshape(-1, 3), axis=0).astype(float)


def sphere(count):
    """Return an .obj whose vertices lie on a unit sphere."""
    angles = np.random.default_rng(1).normal(size=(count, 3))
    points = angles / np.linalg.norm(angles, axis=1, keepdims=True)
    lines = [f'v {x} {y} {z}' for x, y, z in points]
    return '\n'.join(lines + [f'f {i} {i + 1} {i + 2}' for i in range(1, count - 1)])


def test_the_hull_of_few_points_is_exact_and_scaled(write, files):
    points = read_hull(hull_file(files, write('m.obj', TRIANGLE), (2.0, 3.0, 4.0)))
    assert points.tolist() == [[0, 0, 0], [0, 3, 0], [2, 0, 0]]


def test_hull_of_many_points_is_reduced_and_nearly_fills_the_mesh(write, files):
    path = write('ball.obj', sphere(6000))
    points = read_hull(hull_file(files, path))
    assert len(points) <= HULL_DIRECTIONS + 6
    full, _ = read_mesh(path).triangles()
    np.testing.assert_allclose(points.max(axis=0), full.max(axis=0), rtol=1e-6)
    directions = np.random.default_rng(2).normal(size=(500, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    lost = (full @ directions.T).max(axis=0) - (points @ directions.T).max(axis=0)
    assert lost.max() < 0.01


def test_points_that_coincide_count_once():
    random = np.random.default_rng(1)
    points = random.integers(-2, 3, size=(200, 3)).astype(float)
    np.testing.assert_array_equal(engine_files._distinct(points), np.unique(points, axis=0))
    assert len(engine_files._distinct(points[:1])) == 1


def test_hull_ignores_unused_vertices(write, files):
    path = write('m.obj', 'v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n')
    assert read_hull(hull_file(files, path)).max() == 1.0


def test_surface_is_exact_and_outward_when_mirrored(write, files):
    path = write('m.obj', TRIANGLE)
    points, faces = read_obj(files.engine_file(Mesh(path, (-1.0, 1.0, 1.0)), exact=True))
    a, b, c = points[faces[0]]
    assert sorted(points.tolist()) == [[-1, 0, 0], [0, 0, 0], [0, 1, 0]]
    assert np.cross(b - a, c - a)[2] == 1.0


def test_equal_meshes_share_one_file(write, files, tmp_path):
    first = hull_file(files, write('m.obj', TRIANGLE))
    written = os.stat(first).st_mtime_ns
    other = tmp_path / 'elsewhere'
    other.mkdir()
    (other / 'n.obj').write_text(TRIANGLE)
    assert hull_file(files, str(other / 'n.obj')) == first
    assert os.stat(first).st_mtime_ns == written
    assert len(os.listdir(os.path.dirname(first))) == 1


def test_deleted_file_is_written_again(write, files):
    path = write('m.obj', TRIANGLE)
    shutil.rmtree(os.path.dirname(hull_file(files, path)))
    assert os.path.isfile(hull_file(files, path))


def test_scale_kind_and_content_have_separate_files(write, files):
    path = write('m.obj', TRIANGLE)
    made = {
        hull_file(files, path),
        files.engine_file(Mesh(path), exact=True),
        hull_file(files, path, (1.0, 1.0, math.pi)),
        hull_file(files, write('n.obj', TRIANGLE + 'f 3 2 1\n')),
    }
    assert len(made) == 4


def test_file_exists_while_it_is_in_use(write, files):
    path = write('m.obj', TRIANGLE)
    first, second = hull_file(files, path), hull_file(files, path)
    name = str(first)
    del first
    assert os.path.isfile(name)
    del second
    assert not os.path.exists(name)
    assert os.listdir(os.path.dirname(name)) == []


def test_files_in_use_are_kept_with_concurrent_threads(write, files):
    paths = [write('m.obj', TRIANGLE), write('n.obj', TRIANGLE + 'f 3 2 1\n')]

    def use_repeatedly(number):
        for i in range(100):
            file = hull_file(files, paths[(i + number) % 2])
            assert os.path.getsize(file) > 0

    with ThreadPoolExecutor(4) as threads:
        list(threads.map(use_repeatedly, range(4)))
    file = hull_file(files, paths[0])
    assert os.listdir(os.path.dirname(file)) == [os.path.basename(file)]
