"""Support points of a point cloud."""

import numpy as np
import pytest

from rosbots_description.sim.meshes.support_points import support_points

AXES = np.concatenate([np.eye(3), -np.eye(3)])


def test_support_points_are_unique_and_in_order():
    points = np.array([[0, 0, 0], [2, 2, 0], [1, 0, 0], [-1, 0, 3], [0, -1, -1]], dtype=float)
    assert support_points(points, AXES) == [1, 3, 4]


def test_first_of_equally_far_points_is_used():
    assert support_points(np.array([[1.0, 0, 0], [1.0, 5, 0]]), np.array([[1.0, 0, 0]])) == [0]


@pytest.mark.parametrize('at_once', [1, 7, 1000, 10**6])
def test_result_does_not_depend_on_the_batch_size(at_once, monkeypatch):
    random = np.random.default_rng(1)
    points, directions = random.normal(size=(50, 3)), random.normal(size=(40, 3))
    expected = sorted(
        {
            int(np.argmax(a * points[:, 0] + b * points[:, 1] + c * points[:, 2]))
            for a, b, c in directions
        }
    )
    monkeypatch.setitem(support_points.__globals__, '_AT_ONCE', at_once)
    assert support_points(points, directions) == expected
