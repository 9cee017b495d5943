"""The support points of many."""

import numpy as np
import pytest

from rosbots_description.sim.meshes.support_points import support_points

AXES = np.concatenate([np.eye(3), -np.eye(3)])


def test_the_farthest_points_are_found_each_once_in_order():
    points = np.array([[0, 0, 0], [2, 2, 0], [1, 0, 0], [-1, 0, 3], [0, -1, -1]], dtype=float)
    assert support_points(points, AXES) == [1, 3, 4]


def test_of_points_equally_far_the_first_counts():
    assert support_points(np.array([[1.0, 0, 0], [1.0, 5, 0]]), np.array([[1.0, 0, 0]])) == [0]


@pytest.mark.parametrize('at_once', [1, 7, 1000, 10**6])
def test_how_many_are_looked_at_in_one_go_does_not_matter(at_once, monkeypatch):
    random = np.random.default_rng(1)
    points, directions = random.normal(size=(50, 3)), random.normal(size=(40, 3))
    expected = sorted({int(np.argmax(a * points[:, 0] + b * points[:, 1] + c * points[:, 2]))
                       for a, b, c in directions})
    monkeypatch.setitem(support_points.__globals__, '_AT_ONCE', at_once)
    assert support_points(points, directions) == expected
