"""How hypothesis looks for counterexamples: the same examples every time, unless asked for more.

More of them, and others each time, are tried with the profile `search`: ./rosbots bench fuzz
"""

import tempfile
from pathlib import Path

from hypothesis import HealthCheck, settings
from hypothesis.configuration import set_hypothesis_home_dir

# What it remembers by itself, not counterexamples; nothing of it belongs into the source tree.
set_hypothesis_home_dir(Path(tempfile.gettempdir()) / 'rosbots_hypothesis')

# Engine and file system are slow now and then, which says nothing about the code.
COMMON = settings(
    deadline=None,
    database=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)
settings.register_profile('repeat', COMMON, derandomize=True, max_examples=40)
settings.register_profile('search', COMMON, max_examples=1000)
settings.load_profile('repeat')
