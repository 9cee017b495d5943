"""Laser scans: the plugins libgazebo_ros_laser.so and libgazebo_ros_gpu_laser.so.

Tags, defaults and namespaces are those of gazebo_ros_pkgs 2.9.2.
"""

from collections.abc import Mapping

from ..plugin_registry import register_in_sensor
from .base import LogsDefaults, SensorPlugin
from .ray import RaySensor, Scan


@register_in_sensor('libgazebo_ros_gpu_laser.so')
@register_in_sensor('libgazebo_ros_laser.so')
class LaserPlugin(LogsDefaults, SensorPlugin[Scan]):
    """Publishes scans. Output: `scan`, unless <topicName> is empty."""

    sensor_class = RaySensor
    topic_names: Mapping[str, str] = {'scan': '<topicName>'}
    prefix = 'Laser plugin '
    empty_namespace = '{}'

    def load(self) -> None:
        """Read the tags."""
        self.params.read('frameName', '/world')
        self.scan = self.output('scan', bool(self.params.read('topicName', '/world')))

    def process(self, reading: Scan) -> None:
        """Send a scan."""
        self.scan.send(reading)
