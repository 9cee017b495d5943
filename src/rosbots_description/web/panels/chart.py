"""Curves of the last seconds as tables, without a page."""

import math
from collections import deque

import numpy as np
from numpy.typing import NDArray

WINDOW, STEP = 30.0, 0.05  # that is shown, and the distance of its columns [s, simulated]
HOLD = 2.0  # [s, simulated] after which a value is no longer shown


class Chart:
    """Samples of curves; not thread-safe."""

    def __init__(self) -> None:
        self._curves: dict[str, deque[tuple[float, float]]] = {}

    @property
    def curves(self) -> tuple[str, ...]:
        """Return the names of the curves."""
        return tuple(self._curves)

    def add(self, curve: str) -> None:
        """Add a curve without samples."""
        self._curves[curve] = deque()

    def remove(self, curve: str) -> None:
        """Remove a curve."""
        del self._curves[curve]

    def clear(self) -> None:
        """Remove all samples."""
        for samples in self._curves.values():
            samples.clear()

    def note(self, curve: str, time: float, value: float) -> None:
        """Add a sample; one long before the last one [s] means that time was reset.

        One that is late, such as of the second publisher of a topic, takes the time of the last.
        """
        samples = self._curves[curve]
        if samples and time < samples[-1][0] - HOLD:
            samples.clear()
        if samples:
            time = max(time, samples[-1][0])
        while samples and time - samples[0][0] > 2.0 * WINDOW:
            samples.popleft()
        samples.append((time, value if math.isfinite(value) else math.nan))

    def table(self, now: float) -> tuple[NDArray[np.float64], ...]:
        """Return times [s] up to now, and the newest value of each curve at each; NaN for none."""
        columns = np.arange(math.ceil((now - WINDOW) / STEP), math.floor(now / STEP) + 1)
        times = STEP * columns[max(0, -int(columns[0])) :]
        return times, *(_values(samples, times) for samples in self._curves.values())


def _values(samples: deque[tuple[float, float]], times: NDArray[np.float64]) -> NDArray[np.float64]:
    if not samples:
        return np.full(len(times), math.nan)
    taken, values = np.array(samples).T
    last = np.searchsorted(taken, times + STEP / 1000.0, side='right') - 1
    return np.where((last < 0) | (times - taken[last] > HOLD), math.nan, values[last])
