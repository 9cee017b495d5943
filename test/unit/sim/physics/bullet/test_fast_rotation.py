"""Energy that a free rigid body gains per step in PyBullet, compared with theory."""

import itertools

import numpy as np
import pytest

from rosbots_description.sim.core.arrays import rotation_matrix
from rosbots_description.sim.physics.bullet import fast_rotation
from rosbots_description.sim.physics.bullet.fast_rotation import energy_growth_rate

MOMENTS = (0.1, 0.2, 0.3)


@pytest.mark.parametrize(
    ('moments', 'velocity'),
    [
        (MOMENTS, (0.0, 50.0, 0.0)),  # about a principal axis
        ((0.2, 0.2, 0.2), (3.0, 4.0, 5.0)),  # a ball
        ((0.0, 1.0, 1.0), (1.0, 2.0, 3.0)),  # rotation locked
        (MOMENTS, (0.0, 0.0, 0.0)),
    ],
)
def test_torque_free_rotation_gains_no_energy(moments, velocity):
    assert energy_growth_rate(moments, velocity, 1e-3) == 0.0


def test_relative_gain_grows_with_speed_squared_and_step_size():
    share = energy_growth_rate(MOMENTS, (3.0, 4.0, 5.0), 1e-3)
    assert energy_growth_rate(MOMENTS, (6.0, 8.0, 10.0), 1e-3) == pytest.approx(4.0 * share)
    assert energy_growth_rate(MOMENTS, (3.0, 4.0, 5.0), 2e-3) == pytest.approx(2.0 * share)


def test_relative_gain_is_that_of_explicit_euler():
    (a, b, c), (x, y, z), dt = MOMENTS, (3.0, 4.0, 5.0), 1e-5
    after = (
        x + dt * (b - c) / a * y * z,
        y + dt * (c - a) / b * z * x,
        z + dt * (a - b) / c * x * y,
    )
    energies = [sum(i * w * w for i, w in zip(MOMENTS, v, strict=True)) for v in ((x, y, z), after)]
    gained = (energies[1] / energies[0] - 1.0) / dt
    assert energy_growth_rate(MOMENTS, (x, y, z), dt) == pytest.approx(gained, rel=1e-3)


def test_vectors_are_turned_back_into_the_frame_of_each_link():
    random = np.random.default_rng(4)
    turns = random.normal(size=(20, 4))
    turns /= np.linalg.norm(turns, axis=1)[:, None]
    vectors = random.normal(size=(20, 3))
    expected = [
        rotation_matrix(tuple(turn)).T @ vector for turn, vector in zip(turns, vectors, strict=True)
    ]
    assert np.allclose(fast_rotation._rotated_back(turns, vectors), expected, atol=1e-12)
    pairs = list(itertools.pairwise(vectors))
    assert (
        fast_rotation._cross(vectors[:-1], vectors[1:])
        == [np.cross(one, other) for one, other in pairs]
    ).all()
