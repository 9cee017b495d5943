"""Range finders: the plugin libgazebo_ros_range.so of gazebo_ros_pkgs 2.9.2."""

from collections.abc import Mapping
from typing import NamedTuple

from ..core import PluginError
from ..plugin_registry import register_in_sensor
from .base import LogsDefaults, SensorPlugin
from .noise import gaussian, noisy
from .numbers import MAX_FLOAT32
from .ray import MAX_ANGLE, RaySensor, Scan


class Distance(NamedTuple):
    """Distance to the nearest object in a cone; range_max if there is none."""

    range: float  # [m]
    range_min: float  # [m]
    range_max: float  # [m]
    field_of_view: float  # [rad]
    is_infrared: bool  # else ultrasound


@register_in_sensor('libgazebo_ros_range.so')
class RangePlugin(LogsDefaults, SensorPlugin[Scan]):
    """Publishes the minimum of all rays. Output: `range`."""

    sensor_class = RaySensor
    sensor: RaySensor
    topic_names: Mapping[str, str] = {'range': '<topicName>'}
    prefix = 'Range plugin '

    def load(self) -> None:
        """Read the tags.

        Raises:
            PluginError: a number is out of range.
        """
        read = self.params.read
        read('topicName', '/range')
        read('frameName', '/world')
        is_infrared = read('radiation', 'ultrasound') != 'ultrasound'
        field_of_view = read('fov', 0.05)
        if abs(field_of_view) > MAX_ANGLE:
            raise PluginError(
                f'{self.prefix}<fov> is {field_of_view:g} rad; it must lie between '
                f'-{MAX_ANGLE:g} and {MAX_ANGLE:g}'
            )
        self._fixed = self.sensor.range_min, self.sensor.range_max, field_of_view, is_infrared
        self.noise = gaussian(read('gaussianNoise', 0.0), '<gaussianNoise>')
        self.rate = self.params.rate('updateRate', 0.0)
        self.range = self.output('range', bool(self.params.values['topicName']))

    def process(self, _reading: Scan) -> None:
        """Send the minimum range, with noise if there is a hit."""
        least, most = float(self.sensor.rays[0].min()), self.sensor.range_max
        if least < most and self.noise:
            (least,) = noisy((least,), (self.noise,), self.random, self.world.clock.steps)
            least = max(-MAX_FLOAT32, min(most, least))
        self.range.send(Distance(least, *self._fixed))
