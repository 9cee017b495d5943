"""The services of the node, grouped by subject; importing registers them."""

from . import (  # noqa: F401
    friction,
    holding,
    insertion,
    joints,
    lights,
    link_properties,
    links,
    models,
    physics,
    saving,
    simulation,
    spawning,
    stepping,
)
from .registry import EXTENSIONS, SERVICES, advertise, respond

__all__ = ['EXTENSIONS', 'SERVICES', 'advertise', 'respond']
