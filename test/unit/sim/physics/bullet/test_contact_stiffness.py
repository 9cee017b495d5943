"""Restitution of contacts."""

import pytest

from rosbots_description.sim.description.model_spec import Surface
from rosbots_description.sim.physics.bullet.contact_stiffness import restitution


@pytest.mark.parametrize(('surface', 'expected'), [
    ({'restitution': 0.64}, 0.0),  # limited by the default max_vel
    ({'restitution': 0.64, 'max_vel': 10.0}, 0.0),  # and by the default threshold
    ({'restitution': 0.64, 'max_vel': 10.0, 'threshold': 0.1}, 0.8),
    ({'restitution': 9.0, 'max_vel': 10.0, 'threshold': 0.1}, 1.0),
])
def test_restitution_of_equal_surfaces_is_theirs(surface, expected):
    assert restitution(Surface(**surface)) == pytest.approx(expected)
