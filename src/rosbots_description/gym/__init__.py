"""Environments of Gymnasium, without ROS: `SimEnv`, the base to write one's own, and four tasks.

Importing registers the tasks and loads no simulator: each name is imported on first use.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from .registration import register_envs

if TYPE_CHECKING:
    from .env import SimEnv
    from .parallel import ParallelEnv, make_parallel
    from .randomisation import Randomisation

__all__ = ['ParallelEnv', 'Randomisation', 'SimEnv', 'make_parallel', 'register_envs']

_HOMES = {
    'ParallelEnv': 'parallel',
    'Randomisation': 'randomisation',
    'SimEnv': 'env',
    'make_parallel': 'parallel',
}


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(import_module(f'.{_HOMES[name]}', __name__), name)


register_envs()
