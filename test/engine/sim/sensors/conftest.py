"""The scene in which sensors of Gazebo were recorded."""

import pytest
from support.pictures import recorded_world


@pytest.fixture
def scene():
    with recorded_world() as world:
        yield world
