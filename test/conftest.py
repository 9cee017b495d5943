"""How hypothesis looks for counterexamples, in which order files are tested, and a fixture of all.

Hypothesis tries the same examples every time. More of them, and others each time, are tried with
the profile `search`: ./rosbots bench fuzz
"""

import ctypes
import gc
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
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

# PyBullet takes a block of 28 MB for each world, of which a run opens hundreds. By default the C
# library gives it back to the system with each, and the next costs 7,000 page faults: 17 ms.
M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3  # of malloc.h
ctypes.CDLL(None).mallopt(M_TRIM_THRESHOLD, 128 << 20)
ctypes.CDLL(None).mallopt(M_MMAP_THRESHOLD, 64 << 20)

# Collecting tests makes objects that all stay: looking for garbage costs a third of its time.
gc.disable()

# Each takes ten seconds or more: they begin first, so that the processes of a phase end together.
LONGEST = (
    'test_strangers',
    'test_batches_on_ray',
    'test_xacro_sandbox',
    'test_hostile',
    'test_fork_server',
    'test_benchmark_run',
    'test_wheels_obey_mechanics',
    'test_camera',
    'test_varied_robots',
    'test_motion_as_in_gazebo',
    'test_energy',
    'test_parallel',
)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Sort the files that take longest to the front; their order and all others stay."""
    items.sort(key=lambda item: item.path.stem not in LONGEST)


def pytest_collection_finish() -> None:
    """Let the garbage collector leave alone what stays until the end, and look seldom for more."""
    gc.freeze()
    gc.set_threshold(20_000)
    gc.enable()


@pytest.fixture
def no_collection() -> Iterator[None]:
    """Switch the garbage collector off, which would free what is left behind, here or earlier."""
    gc.disable()
    yield
    gc.enable()
