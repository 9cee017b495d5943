"""Polygons of .obj files, and decimation of fine meshes."""

import tracemalloc

import numpy as np
import pytest

from rosbots_description.sim.meshes.decimation import decimated
from rosbots_description.sim.meshes.obj import read_obj

CORNERS = 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0.5 0\nv -1 0.2 0\n'


def parts_of(text):
    return read_obj(text.encode(), lambda _: '')


def area(part):
    a, b, c = np.moveaxis(part.vertices[part.faces], 1, 0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0


@pytest.mark.parametrize(
    ('faces', 'count', 'expected'),
    [
        ('f 1 2 3 4\n', 2, 1.0),  # quads only
        ('f 1/1 2/1 3/1 4/1\n', 2, 1.0),
        ('f 1//1 2//1 3//1\nf 1 3 4\nvn 0 0 1\n', 2, 1.0),
        ('f -6 -5 -4 -3\n', 2, 1.0),
        ('f 1 2 3 4 5\n', 3, 1.5),
        ('f 1 2 3 4 5 6\n', 4, 1.65),
        ('f 1 2 \\\n3 4\n', 2, 1.0),
        ('f 1//1 2//1 3//1\nf 1 2\nf 4//1 1//1 3//1\nvn 0 0 1\n', 2, 1.0),  # with an edge
    ],
)
def test_polygons_become_triangles(faces, count, expected):
    (part,) = parts_of(CORNERS + faces)
    assert len(part.faces) == count
    assert area(part) == pytest.approx(expected)


def test_negative_index_counts_from_its_own_line():
    text = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 9 9 9\n'
    (part,) = parts_of(text)
    assert part.vertices[part.faces[0]].tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_a_vertex_with_two_normals_becomes_two():
    text = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 2\nf 1//1 2//1 3//1\nf 1//2 3//1 2//1\n'
    (part,) = parts_of(text)
    assert len(part.vertices) == 4
    assert part.normals[part.faces[1, 0]].tolist() == [0, 0, 2]


@pytest.mark.parametrize('corner', ['{}', '{0}//{0}', '{0}/{0}/{0}'])
def test_a_large_file_is_read_in_little_memory(corner):
    count = 5000
    content = ''.join(
        f'v {i}.123456 0.123456 0.123456\nvn 0.123456 {i} 0.123456\n' for i in range(count)
    )
    content += ''.join(
        'f {} {} {}\n'.format(*(corner.format(i + k) for k in range(1, 4)))
        for i in range(count - 2)
        for _ in range(2)
    )
    tracemalloc.start()
    try:
        parts_of(content)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 8 * len(content)


def test_fine_surface_is_decimated_in_place():
    count = 100
    x, y = np.meshgrid(np.linspace(0, 1, count), np.linspace(0, 1, count), indexing='ij')
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(count**2)], axis=1)
    i = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).ravel()
    faces = np.concatenate(
        [
            np.stack([i, i + count, i + 1], axis=1),
            np.stack([i + 1, i + count, i + count + 1], axis=1),
        ]
    )
    fewer, triangles, kept, cell = decimated(vertices, faces, 2000)
    assert 500 < len(triangles) <= 2000
    assert (fewer == vertices[kept]).all()
    assert fewer[np.unique(triangles)].max() == pytest.approx(1.0, abs=2 * cell)
    assert fewer.min() == 0.0


def test_mesh_of_a_point_is_decimated():
    faces = np.zeros((50, 3), dtype=int)
    _, triangles, _, _ = decimated(np.zeros((3, 3)), faces, 10)
    assert len(triangles) == 1
