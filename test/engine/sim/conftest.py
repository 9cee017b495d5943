"""The world of most tests of the simulator; folders may have another one."""

import pytest
from support import empty_world


@pytest.fixture
def world():
    """Yield a world with a ground plane."""
    with empty_world() as made:
        yield made
