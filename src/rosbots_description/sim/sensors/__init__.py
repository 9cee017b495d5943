"""What `<sensor>` tags load: sensors, and the plugins in them; importing registers them."""

from . import laser, ray  # noqa: F401
from .base import Sensor, SensorPlugin
from .laser import LaserPlugin
from .ray import Scan

__all__ = ['LaserPlugin', 'Scan', 'Sensor', 'SensorPlugin']
