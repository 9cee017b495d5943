"""One expansion of each robot of this project, which a hundred tests spawn from its xacro file."""

import pytest
from support import ROOT

from rosbots_description.sim.public import descriptions

OURS = str(ROOT / 'urdf')


@pytest.fixture(scope='session', autouse=True)
def fixture_expanded_once():
    """Let xacro expand our files once for the same arguments; they do not change."""
    expand, expanded = descriptions.expand_xacro, {}

    def once(path, arguments, find_package):
        if not path.startswith(OURS):
            return expand(path, arguments, find_package)
        key = path, str(sorted(arguments.items())), find_package('rosbots_description')
        if key not in expanded:
            expanded[key] = expand(path, arguments, find_package)
        return expanded[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(descriptions, 'expand_xacro', once)
        yield
