"""Reproducible random numbers: they depend on seed, name and step, not on the readers."""

import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..core import PluginError
from ..description import Element
from .numbers import number

if TYPE_CHECKING:
    from ..runtime import World


class RandomSteps:
    """The random numbers of one sensor or plugin, by the world's seed, a new sequence each step."""

    def __init__(self, world: 'World', name: str) -> None:
        self._world = world
        self._bits = np.random.Philox(key=[0, zlib.crc32(name.encode())])
        self._state = self._bits.state
        self._generator = np.random.Generator(self._bits)

    def __deepcopy__(self, _memo: dict[int, object]) -> 'RandomSteps':
        """Return itself: nothing of a step outlasts it. A copied generator has bits of its own."""
        return self

    def at(self, step: int) -> np.random.Generator:
        """Return the generator at the start of a step's sequence."""
        self._state['state']['key'][0] = self._world.seed % (1 << 64)
        self._state['state']['counter'][2] = step  # leaves 2^128 blocks for each step
        self._bits.state = self._state
        return self._generator


@dataclass(frozen=True)
class GaussianNoise:
    """Gaussian noise, as in <noise>."""

    mean: float = 0.0
    deviation: float = 0.0

    def __bool__(self) -> bool:
        return self.mean != 0.0 or self.deviation != 0.0

    def added_to(
        self, values: NDArray[np.float64], generator: np.random.Generator, scale: float = 1.0
    ) -> NDArray[np.float64]:
        """Return the values with independent noise added to each; `scale` is of the deviation."""
        return values + generator.normal(self.mean, scale * self.deviation, np.shape(values))


def read_noise(element: Element | None) -> GaussianNoise:
    """Return the noise of a <noise> element; no noise if it is missing or of another type.

    Raises:
        PluginError: a number is not finite, or the deviation is negative.
    """
    kind = None if element is None else element.child('type')
    written = (
        kind.text
        if kind is not None
        else ''
        if element is None
        else element.attributes.get('type', '')
    )
    if element is None or written not in ('gaussian', 'gaussian_quantized'):
        return GaussianNoise()
    deviation = number(element, 'stddev', 0.0)
    if deviation < 0.0:
        raise PluginError(
            f'line {element.line}: <stddev> of <noise> is {deviation:g}; it must not be negative'
        )
    return GaussianNoise(number(element, 'mean', 0.0), deviation)


def gaussian(deviation: float, what: str) -> GaussianNoise:
    """Return the noise for the standard deviation in a plugin's tag.

    Raises:
        PluginError: the deviation is negative or not finite.
    """
    if not (math.isfinite(deviation) and deviation >= 0.0):
        raise PluginError(f'{what} is {deviation:g}; it must be at least 0')
    return GaussianNoise(0.0, deviation)


def noisy(
    values: Sequence[float],
    noises: Sequence[GaussianNoise],
    random: RandomSteps,
    step: int,
    scale: float = 1.0,
) -> tuple[float, ...]:
    """Return the values, each with its own noise for that step; `scale` is of the deviations."""
    standard = random.at(step).standard_normal(len(values)).tolist()
    return tuple(
        value + noise.mean + scale * noise.deviation * one
        for value, noise, one in zip(values, noises, standard, strict=True)
    )
