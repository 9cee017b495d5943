"""The errors of sensors in hector_gazebo_plugins 0.5.4: scale, offset, drift and noise."""

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..core import IDENTITY, PluginError, Pose, Vector, as_vector, parse_numbers
from ..plugins import ModelPlugin
from .noise import RandomSteps

if TYPE_CHECKING:
    from ..runtime import Link

Floats = NDArray[np.float64]
_WAVES = 64


class ErrorModel:
    """The errors on the values of a plugin, each in the unit of the values.

    The drift is a first-order Gauss-Markov process of standard deviation <drift> and time constant
    1 / <driftFrequency>. It is made of waves with the frequencies of that spectrum, so that it
    depends on the time alone, not on the readings before.

    Attributes:
        frequency: (n,) inverse of the drift's time constant [1/s].
        noise: (n,) standard deviation of the noise.
        variances: (n,) of drift and noise together.
    """

    def __init__(self, plugin: ModelPlugin, prefix: str, axes: int = 3) -> None:
        """Read the tags that begin with `prefix`, e.g. <accelDrift>, or <drift> for ''.

        Raises:
            PluginError: a text is not one number or one for each axis, or a size is negative.
        """

        def read(word: str, default: float = 0.0, least: float = 0.0) -> Floats:
            tag = f'{prefix}{word}' if prefix else f'{word[0].lower()}{word[1:]}'
            return _numbers(plugin, tag, default, least, axes)

        self._scale = read('ScaleError', 1.0, -math.inf)
        self._offset = read('Offset', 0.0, -math.inf)
        drift, self.frequency = read('Drift'), read('DriftFrequency', 1.0 / 3600.0)  # [1/s]
        self.noise = read('GaussianNoise')
        self.variances = drift**2 + self.noise**2
        who = f'{plugin.model.name}::{plugin.spec.name}::{prefix}'
        random = RandomSteps(plugin.world, who).at(0)
        self._rates = self.frequency[:, None] * random.standard_cauchy((axes, _WAVES))  # [rad/s]
        phases = random.uniform(0.0, math.tau, (axes, _WAVES))
        self._waves = (drift * math.sqrt(2.0 / _WAVES))[:, None] * np.exp(1j * phases)
        self.reset()

    def reset(self) -> None:
        """Begin with the drift of the time 0."""
        self._removed, self._since = np.zeros(len(self._scale)), 0.0

    def calibrate(self, seconds: float) -> None:
        """Remove the drift of a time [s]; it returns with its time constant."""
        self.reset()
        self._removed, self._since = self.drift(seconds), seconds

    def drift(self, seconds: float) -> Floats:
        """Return the drift (n,) at a time [s]."""
        drift = (self._waves * np.exp(1j * self._rates * seconds)).sum(axis=1).real
        left: Floats = drift - self._removed * np.exp(-self.frequency * (seconds - self._since))
        return left

    def integrated_drift(self, seconds: float, frequency: Floats) -> Floats:
        """Return the integral of the drift from 0 to a time [s], which decays at `frequency`."""
        rates = frequency[:, None] + 1j * self._rates
        there = rates != 0.0
        swing = np.exp(1j * self._rates * seconds) - np.exp(-frequency * seconds)[:, None]
        sums = np.where(there, swing / np.where(there, rates, 1.0), seconds)
        found: Floats = (self._waves * sums).sum(axis=1).real
        return found

    def bias(self, seconds: float) -> Floats:
        """Return offset and drift (n,) at a time [s]."""
        return self._offset + self.drift(seconds)

    def measured(self, values: Vector, bias: Floats, random: np.random.Generator) -> Vector:
        """Return three values with scale, `bias` and noise."""
        noise = self.noise * random.standard_normal(3)
        return as_vector((np.array(values) * self._scale + bias + noise).tolist())


def find_body(plugin: ModelPlugin) -> 'tuple[Link, Pose]':
    """Return the link <bodyName>, as `ModelPlugin.link`; the model's first link if it is missing.

    Raises:
        PluginError: there is no such link.
    """
    if plugin.params.text('bodyName') is None:
        return next(iter(plugin.model.links.values())), IDENTITY
    return plugin.link('bodyName')


def _numbers(plugin: ModelPlugin, tag: str, default: float, least: float, axes: int) -> Floats:
    """Return the numbers of a tag, one for each axis; a single one counts for all."""
    text = plugin.params.text(tag) or f'{default}'
    numbers = parse_numbers(text, axes) or parse_numbers(text, 1)
    if numbers is None:
        takes = 'a finite number' if axes == 1 else f'{axes} finite numbers'
        raise PluginError(f"{plugin.log_prefix}<{tag}> is '{text}'; it takes {takes}")
    if min(numbers) < least:
        raise PluginError(f"{plugin.log_prefix}<{tag}> is '{text}'; it must not be negative")
    return np.broadcast_to(numbers, (axes,)).copy()
