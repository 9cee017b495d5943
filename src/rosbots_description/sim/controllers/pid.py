"""The PID law of control_toolbox: u = p e + i ∫e dt + d de/dt, with a clamped integral term."""

import math
from typing import NamedTuple

from .errors import ControllerError
from .parameters import ControllerParameters


class Gains(NamedTuple):
    """Gains per unit of error, and the bounds of the integral term, in units of the output."""

    p: float
    i: float = 0.0
    d: float = 0.0
    i_max: float = 0.0
    i_min: float = 0.0
    antiwindup: bool = False  # clamp the integral itself, not only its term


class Pid:
    """A PID with its memory; `gains` may be replaced at any time."""

    def __init__(self, gains: Gains) -> None:
        self.gains = gains
        self.reset()

    @classmethod
    def from_parameters(cls, params: ControllerParameters) -> 'Pid':
        """Return a PID with the gains p, i, d, i_clamp (or i_clamp_min, i_clamp_max), antiwindup.

        Raises:
            ControllerError: p is absent.
        """
        p = params.number('p')
        if p is None:
            raise ControllerError(f'No p gain specified for pid.  Namespace: {params.namespace}')
        clamp = abs(params.read('i_clamp', 0.0))
        return cls(
            Gains(
                p,
                params.read('i', 0.0),
                params.read('d', 0.0),
                abs(params.read('i_clamp_max', clamp)),
                -abs(params.read('i_clamp_min', clamp)),
                params.read('antiwindup', False),
            )
        )

    def reset(self) -> None:
        """Forget the past."""
        self._integral = self._last_error = 0.0

    def update(self, error: float, period: float, error_rate: float | None = None) -> float:
        """Return the output for an error that lasts for `period` [s].

        Args:
            error_rate: time derivative of the error; by default its change since the last call,
                or since 0 in the first call.
        """
        if period == 0.0 or not math.isfinite(error):
            return 0.0
        if error_rate is None:
            error_rate = (error - self._last_error) / period
            self._last_error = error
        elif not math.isfinite(error_rate):
            return 0.0
        p, i, d, i_max, i_min, antiwindup = self.gains
        self._integral += period * error
        if antiwindup and i:
            low, high = sorted((i_min / i, i_max / i))
            self._integral = min(max(self._integral, low), high)
        integral = i * self._integral
        if not antiwindup:
            integral = min(max(integral, i_min), i_max)
        return p * error + integral + d * error_rate
