"""PyBullet with one body, in place of the engine."""

import pytest
from support.fast_body import Bullet, masses, watched

from rosbots_description.sim.physics.bullet import fast_rotation


@pytest.fixture
def bullet(monkeypatch):
    """What `fast_rotation` reads and sets."""
    made = Bullet()
    monkeypatch.setattr(fast_rotation, 'pybullet', made.called())
    return made


@pytest.fixture
def bodies(bullet):
    """The fast bodies of a world in which one is, which has made a step in the air."""
    bodies = watched(masses())
    bodies.after_step()
    return bodies
