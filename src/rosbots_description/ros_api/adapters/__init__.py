"""The topics of each plugin; importing registers the adapters."""

from . import (  # noqa: F401
    cameras,
    contacts,
    controllers,
    drives,
    force,
    imus,
    ray_sensors,
    state,
    wheel_slip,
    wrenches,
)
from .registry import Adapters

__all__ = ['Adapters']
