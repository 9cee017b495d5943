"""Rays find the first triangle, by the tree as by trying all of them."""

import numpy as np
import pytest

from rosbots_description.sim.meshes import TriangleTree


def all_distances(triangles, start, way):
    """Return the first hits by solving for each ray and each triangle."""
    found = np.full(len(start), np.inf)
    for ray, (begin, along) in enumerate(zip(start, way, strict=True)):
        for a, b, c in triangles:
            matrix = np.array([b - a, c - a, -along]).T
            if abs(np.linalg.det(matrix)) > 1e-14:
                u, v, distance = np.linalg.solve(matrix, begin - a)
                if min(u, v, 1.0 - u - v, distance) >= 0.0:
                    found[ray] = min(found[ray], distance)
    return found


@pytest.mark.parametrize('number', [1, 2, 8, 9, 100])
def test_tree_finds_what_trying_all_triangles_finds(number):
    random = np.random.default_rng(number)
    triangles = random.normal(size=(number, 1, 3)) + random.normal(size=(number, 3, 3)) * 0.5
    start = random.normal(size=(60, 3)) * 3.0
    aims = triangles.mean(axis=1)[random.integers(number, size=60)]
    way = aims - start
    way /= np.linalg.norm(way, axis=1)[:, None]
    found = TriangleTree(triangles).distances(start, way)
    assert np.isfinite(found).all()
    assert found == pytest.approx(all_distances(triangles, start, way), abs=1e-9)


def test_both_sides_are_hit_and_nothing_behind_the_start():
    floor = np.array([[[0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [0.0, 2.0, 1.0]]])
    start = np.array([[0.5, 0.5, 0.0], [0.5, 0.5, 3.0], [0.5, 0.5, 3.0], [5.0, 5.0, 0.0]])
    way = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]])
    assert TriangleTree(floor).distances(start, way).tolist() == [1.0, 2.0, np.inf, np.inf]


def test_no_ray_slips_between_triangles_or_along_the_planes_of_a_grid():
    n = 30
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0), indexing='ij')
    corner = np.stack([x, y, np.zeros_like(x)], axis=2)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[:-1, 1:], corner[1:, 1:]
    triangles = np.concatenate([np.stack([a, b, c], 2), np.stack([b, d, c], 2)]).reshape(-1, 3, 3)
    start = corner.reshape(-1, 3) + np.array((0.0, 0.0, 2.0))  # straight above each vertex
    way = np.broadcast_to((0.0, 0.0, -1.0), start.shape)
    assert TriangleTree(triangles).distances(start, way) == pytest.approx(2.0)


def test_more_rays_than_go_down_together_and_none():
    tree = TriangleTree(np.array([[[-9.0, -9.0, 1.0], [9.0, -9.0, 1.0], [0.0, 9.0, 1.0]]]))
    start, way = np.zeros((5000, 3)), np.tile((0.0, 0.0, 1.0), (5000, 1))
    assert (tree.distances(start, way) == 1.0).all()
    assert tree.distances(start[:0], way[:0]).shape == (0,)


def test_triangles_without_area_are_not_hit():
    flat = np.full((20, 3, 3), 1.0)
    assert np.isinf(TriangleTree(flat).distances(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]])))
