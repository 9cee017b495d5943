"""Ray sensors: ranges in many directions, by the <ray> element of a `<sensor>`.

Angles, order, limits and interpolation are those of Gazebo. Rays start at the minimum range, so
that nearer objects are not seen. They hit collisions, including those of their own robot.
"""

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core import PluginError
from ..description import Element
from ..plugin_registry import register_sensor
from .base import Sensor
from .noise import read_noise
from .numbers import MAX_FLOAT32, child_at, count, number
from .rays import RayFan, RayScene, Sweep

MAX_SAMPLES = 1_000_000  # in all rows; such a scan takes half a second
MAX_ANGLE = 100.0  # [rad]

Floats = NDArray[np.float64]


class Scan(NamedTuple):
    """A laser scan: rows from the lowest, each from angle_min to angle_max.

    Attributes:
        ranges: (n,) [m] from the sensor's origin; inf without a hit up to range_max.
        intensities: (n,) laser_retro of the surface hit, 0 without a hit.
    """

    ranges: Floats
    intensities: Floats
    angle_min: float  # [rad] about the sensor's z
    angle_max: float  # [rad]
    angle_increment: float  # [rad] between neighbours of a row
    range_min: float  # [m]
    range_max: float  # [m]


def read_sweep(element: Element | None, samples: int) -> Sweep:
    """Return the sweep of <horizontal> or <vertical>; `samples` is the default of <samples>.

    Raises:
        PluginError: a number is out of range.
    """
    if element is None:
        return Sweep(samples, samples, 0.0, 0.0)
    samples = count(element, 'samples', samples, MAX_SAMPLES)
    resolution = number(element, 'resolution', 1.0)
    if not 1.0 <= samples * resolution <= MAX_SAMPLES:
        raise PluginError(
            f'line {element.line}: <resolution> is {resolution:g}; with {samples} '
            f'<samples> it must give 1 to {MAX_SAMPLES} ranges'
        )
    angles = []
    for tag in ('min_angle', 'max_angle'):
        angles.append(number(element, tag, 0.0))
        if abs(angles[-1]) > MAX_ANGLE:
            raise PluginError(
                f'line {element.line}: <{tag}> is {angles[-1]:g} rad; it must lie '
                f'between -{MAX_ANGLE:g} and {MAX_ANGLE:g}'
            )
    return Sweep(samples, int(samples * resolution), *angles)


@register_sensor('gpu_ray')
@register_sensor('ray')
class RaySensor(Sensor):
    """Casts rays; its readings are of type `Scan`. A gpu_ray works alike.

    `rays` are ranges [m] and intensities of the rays of the last reading, without noise and
    interpolation, and range_max without a hit.
    """

    rays: tuple[Floats, Floats]

    def load(self) -> None:
        """Read angles, limits and noise."""
        ray = self.spec.element.child('ray') or self.spec.element.child('lidar')
        if ray is None:
            raise PluginError(
                f'line {self.spec.element.line}: a <sensor> of type '
                f"'{self.spec.type}' without <ray>"
            )
        self.horizontal = read_sweep(child_at(ray, 'scan/horizontal'), 640)
        self.vertical = read_sweep(child_at(ray, 'scan/vertical'), 1)
        self.range_min = number(ray, 'range/min', 0.0)
        self.range_max = number(ray, 'range/max', 0.0)
        if not 0.0 <= self.range_min < self.range_max <= MAX_FLOAT32:
            raise PluginError(
                f'line {ray.line}: <range> is from {self.range_min:g} to '
                f'{self.range_max:g} m; it must begin at 0 or more and end beyond, '
                f'at most at {MAX_FLOAT32:g}, which is all that a scan can hold'
            )
        total = max(
            self.horizontal.samples * self.vertical.samples,
            self.horizontal.count * self.vertical.count,
        )
        if total > MAX_SAMPLES:
            raise PluginError(f'line {ray.line}: {total} rays; at most {MAX_SAMPLES} are cast')
        self.noise = read_noise(ray.child('noise') or child_at(ray, 'range/noise'))
        self.is_noisy = self.noise.deviation > 0.0
        self._scene = RayScene.of(self.world)
        self._scene.add_rays(self, total)
        self.fan = RayFan.of(self.vertical, self.horizontal)
        self.blend = self.fan.blend
        self._is_whole = self.fan.shape == (self.vertical.count, self.horizontal.count)
        spans = max(1, self.horizontal.count - 1)
        self._fixed = (
            self.horizontal.least,
            self.horizontal.greatest,
            (self.horizontal.greatest - self.horizontal.least) / spans,
            self.range_min,
            self.range_max,
        )

    def unload(self) -> None:
        """Free the arrays, which are as large as many models."""
        self._scene.remove_rays(self)
        del self.fan, self.blend
        vars(self).pop('rays', None)

    def shared(self) -> Iterable[object]:
        """Return scene and rays, too, which are not part of the state."""
        return (*super().shared(), self._scene, self.fan, self.blend)

    def cast(self) -> tuple[Floats, Floats]:
        """Return range [m] and intensity of each ray; range_max without a hit."""
        return self._scene.cast(self.pose, self.fan, self.range_min, self.range_max)

    def measure(self) -> Scan:
        """Return a scan."""
        ranges, retro = self.rays = self.cast()
        if not self._is_whole:
            ranges, retro = self.blend.ranges(ranges), self.blend.intensities(retro)
        missed = ranges >= self.range_max
        if self.noise:
            ranges = self.noise.added_to(
                ranges, self.random.at(self.world.clock.steps), self.noise_scale
            )
            ranges = ranges.clip(self.range_min, self.range_max)
        ranges = np.where(missed, math.inf, ranges)
        return Scan(ranges, retro, *self._fixed)
