"""The scene before which cameras of Gazebo were recorded."""

from contextlib import closing

import pytest
from support.pictures import recorded_world


@pytest.fixture
def scene():
    with closing(recorded_world()) as world:
        yield world
