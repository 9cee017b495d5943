"""The services of the node, grouped by what they are about; importing registers them."""

from . import models, simulation, spawning  # noqa: F401
