"""PyBullet with one body, in place of the engine."""

import pytest
from support.fast_body import Bullet

from rosbots_description.sim.physics.bullet import fast_rotation


@pytest.fixture
def bullet(monkeypatch):
    """What `fast_rotation` reads and sets."""
    made = Bullet()
    monkeypatch.setattr(fast_rotation, 'pybullet', made.called())
    return made
