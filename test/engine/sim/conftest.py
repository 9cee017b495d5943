"""The world and the robot of most tests of the simulator; folders may have another world."""

import pytest
from support import SPAWN_POSE, empty_world, robot_spec


@pytest.fixture
def world():
    """Yield a world with a ground plane."""
    with empty_world() as made:
        yield made


@pytest.fixture
def robot(world):
    """Spawn the article's robot as `spawn.launch` does, in the air."""
    return world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
