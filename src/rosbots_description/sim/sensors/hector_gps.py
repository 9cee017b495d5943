"""Satellite navigation: the plugin libhector_gazebo_ros_gps.so of hector_gazebo_plugins 0.5.4.

As upstream, x of the world is north and y is west, turned by <referenceHeading>, on the ellipsoid
of WGS 84 at the reference, and velocities are given in these directions.
"""

import logging
import math
from typing import NamedTuple

from ..core import NANOSECONDS, PluginError, Vector, as_vector
from ..plugin_registry import register
from ..plugins import PeriodicPlugin
from .hector_errors import ErrorModel, find_body
from .noise import RandomSteps

_EQUATORIAL_RADIUS = 6378137.0  # [m]
_FLATTENING = 1.0 / 298.257223563
_SQUARED_ECCENTRICITY = _FLATTENING * (2.0 - _FLATTENING)


class Fix(NamedTuple):
    """A position on the earth."""

    latitude: float  # [deg], as in its message
    longitude: float  # [deg]
    altitude: float  # [m]
    variances: Vector  # [m^2]
    status: int  # as sensor_msgs/NavSatStatus, as is `service`
    service: int


@register('libhector_gazebo_ros_gps.so')
class HectorGps(PeriodicPlugin):
    """Publishes position and velocity of <bodyName>. Outputs: `fix`, `velocity` [m/s]."""

    prefix = 'GazeboRosGps plugin: '
    strictly_after = False
    missing_level = logging.DEBUG

    def load(self) -> None:
        """Read the tags; find the link."""
        read, values = self.params.read, self.params.values
        self._link, self._mount = find_body(self)
        values['frameId'] = '/' + read('frameId', '/world').lstrip('/')  # it gets no tf_prefix
        read('topicName', 'fix')
        read('velocityTopicName', 'fix_velocity')
        latitude = self._within('referenceLatitude', 49.9, -89.999, 89.999)
        self._origin = (latitude, read('referenceLongitude', 8.9), read('referenceAltitude', 0.0))
        heading = math.radians(read('referenceHeading', 0.0))
        self._cos, self._sin = math.cos(heading), math.sin(heading)
        self._status = (
            int(self._within('status', 0.0, -1.0, 2.0)),
            int(self._within('service', 0.0, 0.0, 65535.0)),
        )
        curved = 1.0 - _SQUARED_ECCENTRICITY * math.sin(math.radians(latitude)) ** 2
        vertical = _EQUATORIAL_RADIUS / math.sqrt(curved)
        self._north = vertical * (1.0 - _SQUARED_ECCENTRICITY) / curved  # radii [m]
        self._east = vertical * math.cos(math.radians(latitude))
        self._position, self._speed = ErrorModel(self, ''), ErrorModel(self, 'velocity')
        self.set_rate(self.params.rate('updateRate', 4.0))
        self._random = RandomSteps(self.world, f'{self.model.name}::{self.spec.name}')
        self.fix, self.velocity = self.output('fix'), self.output('velocity')

    def _within(self, tag: str, default: float, least: float, most: float) -> float:
        """Return a number, as `Params.read`.

        Raises:
            PluginError: it is out of range.
        """
        value = self.params.read(tag, default)
        if not least <= value <= most:
            raise PluginError(
                f'{self.log_prefix}<{tag}> is {value:g}; it must lie between {least:g} and {most:g}'
            )
        return value

    def report(self) -> None:
        """Send position and velocity; the drift of the velocity moves the position, too."""
        clock = self.world.clock
        seconds, random = clock.now_ns / NANOSECONDS, self._random.at(clock.steps)
        pose, twist = self._link.state_at(self._mount)
        x, y, z = self._speed.measured(twist.linear, self._speed.bias(seconds), random)
        self.velocity.send((self._cos * x + self._sin * y, self._cos * y - self._sin * x, z))
        bias = self._position.bias(seconds) + self._speed.integrated_drift(
            seconds, self._position.frequency
        )
        x, y, z = self._position.measured(pose.position, bias, random)
        latitude, longitude, altitude = self._origin
        self.fix.send(
            Fix(
                latitude + math.degrees((self._cos * x + self._sin * y) / self._north),
                longitude - math.degrees((self._cos * y - self._sin * x) / self._east),
                altitude + z,
                as_vector(self._position.variances.tolist()),
                *self._status,
            )
        )
