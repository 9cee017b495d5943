"""Environments of Gymnasium, without ROS: `SimEnv`, the base to write one's own, and four tasks.

Importing registers the tasks and loads no simulator: each name is imported on first use.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from .registration import register_envs

if TYPE_CHECKING:
    from .env import SimEnv

__all__ = ['SimEnv', 'register_envs']


def __getattr__(name: str) -> object:
    if name not in __all__:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(import_module('.env', __name__), name)


register_envs()
