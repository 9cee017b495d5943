"""Laser points: the plugin libgazebo_ros_block_laser.so of gazebo_ros_pkgs 2.9.2.

As in Gazebo, a point lies midway between its neighbouring rays, half a ray beside the measured
direction, and a ray without a hit gives a point at the maximum range.
"""

from typing import NamedTuple

import numpy as np

from ..plugin_registry import register_in_sensor
from .base import LogsDefaults, SensorPlugin
from .noise import gaussian
from .ray import Floats, RaySensor, Scan
from .rays import Sweep, directions


class Points(NamedTuple):
    """Points in the sensor's frame, row by row from the lowest."""

    positions: Floats  # (n, 3) [m]
    intensities: Floats  # (n,)


@register_in_sensor('libgazebo_ros_block_laser.so')
class BlockLaserPlugin(LogsDefaults, SensorPlugin[Scan]):
    """Converts rays to points. Output: `points`."""

    sensor_class = RaySensor
    sensor: RaySensor
    prefix = 'Block laser plugin '

    def load(self) -> None:
        """Read the tags; two of them are ignored, as upstream."""
        read = self.params.read
        self.params.ignore('hokuyoMinIntensity', 'updateRate')
        read('frameName', '/world')
        read('topicName', '/world')
        self.noise = gaussian(read('gaussianNoise', 0.0), '<gaussianNoise>')
        self.points = self.output('points', bool(self.params.values['topicName']))
        fan = self.sensor.fan
        pitch = _angles(fan.rows, self.sensor.blend.rows)[:, None]
        yaw = _angles(fan.columns, self.sensor.blend.columns)
        self._ways = np.stack(directions(pitch, yaw), axis=-1).reshape(-1, 3)

    def process(self, _reading: Scan) -> None:
        """Send the points of a sweep."""
        cast, retro = self.sensor.rays
        ranges = self.sensor.blend.ranges(cast)[:, None]
        positions = ranges * self._ways
        if self.noise:
            noise = self.random.at(self.world.clock.steps)
            noisy = self.noise.added_to(positions, noise)
            positions = np.where(ranges < self.sensor.range_max, noisy, positions)
        self.points.send(Points(positions, self.sensor.blend.intensities(retro)))


def _angles(sweep: Sweep, places: Floats) -> Floats:
    return sweep.first + places * sweep.step
