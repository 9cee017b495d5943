"""Rotation matrices of many quaternions at once."""

import numpy as np

from rosbots_description.sim.core.arrays import rotation_matrices, rotation_matrix


def test_matrices_of_many_quaternions_are_those_of_each():
    drawn = np.random.default_rng(1).normal(size=(50, 4))
    unit = drawn / np.linalg.norm(drawn, axis=1)[:, None]
    expected = [rotation_matrix(tuple(one)) for one in unit.tolist()]
    assert np.abs(rotation_matrices(unit) - expected).max() < 1e-15 * 4
    assert np.array_equal(rotation_matrices(np.zeros((0, 4))), np.zeros((0, 3, 3)))
