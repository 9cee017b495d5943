"""The topics of each plugin; importing registers the adapters."""

from . import (  # noqa: F401
    cameras,
    contacts,
    drives,
    force,
    imus,
    ray_sensors,
    ros_control,
    state,
    wheel_slip,
    wrenches,
)
from .registry import Adapters

__all__ = ['Adapters']
