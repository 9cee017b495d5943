"""What `<sensor>` tags load: sensors, and the plugins in them; importing registers them."""

from .base import Sensor, SensorPlugin
from .block_laser import BlockLaserPlugin, Points
from .contact import BumperPlugin, ContactPair, ContactPoint
from .imu import ImuSensorPlugin, Inertia
from .joint_wrench import JointWrench, JointWrenchPlugin
from .laser import LaserPlugin
from .link_imu import LinkImu
from .range import Distance, RangePlugin
from .ray import Scan

__all__ = [
    'BlockLaserPlugin', 'BumperPlugin', 'ContactPair', 'ContactPoint', 'Distance',
    'ImuSensorPlugin', 'Inertia', 'JointWrench', 'JointWrenchPlugin', 'LaserPlugin', 'LinkImu',
    'Points', 'RangePlugin', 'Scan', 'Sensor', 'SensorPlugin',
]
