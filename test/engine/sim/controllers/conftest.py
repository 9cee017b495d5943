"""The world of most tests here."""

import pytest

from rosbots_description.sim import World


@pytest.fixture
def world():
    """Yield Gazebo's empty world, of the public class."""
    with World.empty() as made:
        yield made
