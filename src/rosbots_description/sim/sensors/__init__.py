"""What `<sensor>` tags load: sensors, and the plugins in them; importing registers them."""

from .base import Sensor, SensorPlugin
from .block_laser import BlockLaserPlugin, Points
from .laser import LaserPlugin
from .range import Distance, RangePlugin
from .ray import Scan

__all__ = [
    'BlockLaserPlugin', 'Distance', 'LaserPlugin', 'Points', 'RangePlugin', 'Scan', 'Sensor',
    'SensorPlugin',
]
