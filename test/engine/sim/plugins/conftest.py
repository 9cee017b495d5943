"""The world of most tests here."""

from contextlib import closing

import pytest

from rosbots_description.sim.runtime.world import World


@pytest.fixture
def world():
    """Yield a world without a ground."""
    with closing(World()) as made:
        yield made
