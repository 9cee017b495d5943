"""Point clouds of rotating lasers: libgazebo_ros_velodyne_laser.so and its gpu twin.

Tags, defaults, fields and the order of points are those of velodyne_simulator 1.0.12.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core import Fault, report
from ..plugin_registry import register_in_sensor
from .base import LogsDefaults, SensorPlugin
from .noise import gaussian
from .ray import RaySensor, Scan
from .rays import Sweep, directions

RING_POINT = np.dtype(
    [
        ('x', '<f4'),
        ('y', '<f4'),
        ('z', '<f4'),
        ('intensity', '<f4'),
        ('ring', '<u2'),
        ('time', '<f4'),
    ]
)


class RingCloud(NamedTuple):
    """Points in the sensor's frame, azimuth by azimuth, each from the lowest ring.

    Attributes:
        points: of type `RING_POINT`; (1, n), or (azimuths, rings) if organised, NaN without a hit.
        is_dense: False if points may be NaN.
    """

    points: NDArray[np.void]
    is_dense: bool


@register_in_sensor('libgazebo_ros_velodyne_gpu_laser.so')
@register_in_sensor('libgazebo_ros_velodyne_laser.so')
class VelodynePlugin(LogsDefaults, SensorPlugin[Scan]):
    """Converts scans to points with rings. Output: `cloud`, unless <topicName> is empty."""

    sensor_class = RaySensor
    sensor: RaySensor
    prefix = 'Velodyne laser plugin '

    def load(self) -> None:
        """Read the tags; the namespace is the prefix of the frame, as upstream."""
        read, sensor = self.params.read, self.sensor
        frame, space = read('frameName', '/world'), self.namespace.strip('/')
        if space and not frame.startswith('/'):
            self.params.values['frameName'] = f'/{space}/{frame}'
        self._organised = read('organize_cloud', False, 'false')
        self._least = max(read('min_range', 0.0, '0'), sensor.range_min)
        self._most = min(read('max_range', math.inf, 'infinity'), sensor.range_max)
        self._dimmest = read('min_intensity', -math.inf, 'no clipping')
        if not self._least < self._most:
            what = f'finds no points: <min_range> leaves those beyond {self._least:g} m, and '
            what += f'<max_range> those nearer than {self._most:g} m'
            report(Fault(self.log_prefix + what))
        self.cloud = self.output('cloud', bool(read('topicName', '/points')))
        self._noise = gaussian(read('gaussianNoise', 0.0, '0.0'), '<gaussianNoise>')
        self._ways = directions(_angles(sensor.vertical), _angles(sensor.horizontal)[:, None])

    def process(self, reading: Scan) -> None:
        """Send the points of a scan."""
        shape = self.sensor.vertical.count, self.sensor.horizontal.count
        ranges, shine = (part.reshape(shape).T for part in (reading.ranges, reading.intensities))
        there = (ranges > self._least) & (ranges < self._most) & (shine >= self._dimmest)
        if self._noise:
            ranges = self._noise.added_to(ranges, self.random.at(self.world.clock.steps))
            there &= (ranges > self._least) & (ranges < self._most)
        ranges = np.where(there, ranges, math.nan)
        points = np.zeros(ranges.shape, RING_POINT)
        for axis, way in zip('xyz', self._ways, strict=True):
            points[axis] = ranges * way
        points['intensity'] = np.where(there, shine, math.nan)
        points['ring'] = np.arange(shape[0])
        self.cloud.send(
            RingCloud(points if self._organised else points[there][None], not self._organised)
        )


def _angles(sweep: Sweep) -> NDArray[np.float64]:
    """Return the angles of readings [rad]."""
    spans = max(1, sweep.count - 1)
    return sweep.first + np.arange(sweep.count) * ((sweep.greatest - sweep.least) / spans)
