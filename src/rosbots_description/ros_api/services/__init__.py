"""The services of the node, grouped by what they are about; importing registers them."""

from . import (
    joints,
    lights,
    link_properties,
    links,
    model_setters,
    models,
    physics,
    simulation,
    spawning,
    stepping,
)
