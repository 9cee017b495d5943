"""How commands are kept within a joint's limits, by the laws of joint_limits_interface 0.20.

Positions are [rad or m], velocities [rad/s or m/s], efforts [N m or N], periods [s].
"""

import math
from dataclasses import dataclass, replace
from typing import Protocol

from ..description import CONTINUOUS, ControlledJoint, SoftLimits
from .parameters import ControllerParameters


@dataclass(frozen=True)
class JointLimits:
    """Limits of a joint, infinite where there are none, and its type in the URDF."""

    kind: str = ''
    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    acceleration: float = math.inf
    effort: float = math.inf
    soft: SoftLimits | None = None

    @property
    def has_position_limits(self) -> bool:
        """Whether the position is limited on either side."""
        return self.lower > -math.inf or self.upper < math.inf


def read_limits(described: ControlledJoint | None, params: ControllerParameters) -> JointLimits:
    """Return the limits of the URDF, replaced by those of `joint_limits/<joint>`.

    Args:
        params: the section of the joint; `has_X_limits: false` removes a limit.
    """
    limits = JointLimits()
    if described is not None:
        limits = JointLimits(
            described.type,
            described.lower,
            described.upper,
            described.velocity,
            effort=described.effort,
            soft=described.soft,
        )
    position = params.find('has_position_limits')
    lower, upper = params.number('min_position'), params.number('max_position')
    if position is False:
        limits = replace(limits, lower=-math.inf, upper=math.inf)
    elif position is True and lower is not None and upper is not None:
        limits = replace(limits, lower=lower, upper=upper)
    for name in ('velocity', 'acceleration', 'effort'):
        given, most = params.find(f'has_{name}_limits'), params.number(f'max_{name}')
        if given is False:
            limits = replace(limits, **{name: math.inf})  # type: ignore[arg-type]
        elif given is True and most is not None:
            limits = replace(limits, **{name: abs(most)})  # type: ignore[arg-type]
    if not limits.kind:
        wraps = params.find('angle_wraparound') is True
        endless = CONTINUOUS if wraps else 'prismatic'
        limits = replace(limits, kind='revolute' if limits.has_position_limits else endless)
    return limits


class Enforcement(Protocol):
    """Keeps the commands of one joint within its limits."""

    def enforce(self, command: float, position: float, velocity: float, period: float) -> float:
        """Return the command that is allowed in the state of the joint."""


class PositionSaturation:
    """Limits a position command, and its change per period by the velocity limit."""

    def __init__(self, limits: JointLimits) -> None:
        self._limits = limits
        self._last = math.nan  # NaN: starts at the position of the joint

    def enforce(self, command: float, position: float, velocity: float, period: float) -> float:
        """Return the command that is allowed."""
        last = position if math.isnan(self._last) else self._last
        down, up = self._steps(last, period)
        low, high = max(last + down, self._limits.lower), min(last + up, self._limits.upper)
        self._last = min(max(command, low), high)
        return self._last

    def _steps(self, last: float, period: float) -> tuple[float, float]:
        """Return the least and the greatest change in a period."""
        step = self._limits.velocity * period if period else 0.0
        return -step, step


class PositionSoftLimits(PositionSaturation):
    """Also slows down towards the soft limits: v = k_position * distance."""

    def _steps(self, last: float, period: float) -> tuple[float, float]:
        slowest, fastest = _velocity_bounds(self._limits, last)
        return slowest * period, fastest * period


class EffortSaturation:
    """Limits an effort, which is 0 at most towards an exceeded limit of position or velocity."""

    def __init__(self, limits: JointLimits) -> None:
        self._limits = limits
        self._bounds = limits.lower, limits.upper, limits.velocity, limits.effort

    def enforce(self, command: float, position: float, velocity: float, period: float) -> float:
        """Return the command that is allowed."""
        lower, upper, fastest, high = self._bounds
        low = -high
        if position < lower or velocity < -fastest:
            low = 0.0
        if position > upper or velocity > fastest:
            high = 0.0
        return min(max(command, low), high)


class EffortSoftLimits(EffortSaturation):
    """Bounds an effort by k_velocity * (bound of velocity - velocity)."""

    def enforce(self, command: float, position: float, velocity: float, period: float) -> float:
        """Return the command that is allowed."""
        limits = self._limits
        assert limits.soft is not None
        most = limits.effort
        low, high = (
            min(max(limits.soft.k_velocity * (bound - velocity), -most), most)
            for bound in _velocity_bounds(limits, position)
        )
        return min(max(command, low), high)


class VelocitySaturation:
    """Limits a velocity, and its change per period by the acceleration limit."""

    def __init__(self, limits: JointLimits) -> None:
        self._limits = limits
        self._last = 0.0

    def enforce(self, command: float, position: float, velocity: float, period: float) -> float:
        """Return the command that is allowed."""
        most = self._limits.velocity
        step = self._limits.acceleration * period if period else 0.0
        low, high = max(self._last - step, -most), min(self._last + step, most)
        self._last = min(max(command, low), high)
        return self._last


class VelocitySoftLimits(VelocitySaturation):
    """Also slows down towards the soft limits: v = k_position * distance."""

    def enforce(self, command: float, position: float, velocity: float, period: float) -> float:
        """Return the command that is allowed."""
        limits = self._limits
        low, high = _velocity_bounds(limits, position)
        step = limits.acceleration * period if period else 0.0
        low, high = max(velocity - step, low), min(velocity + step, high)
        return min(max(command, low), high)


def _velocity_bounds(limits: JointLimits, position: float) -> tuple[float, float]:
    """Return the velocity bounds at a position: k_position * distance, within the hard limit."""
    soft, most = limits.soft, min(limits.velocity, 1e9)  # inf * 0 would be NaN
    if soft is None or not limits.has_position_limits:
        return -most, most
    low, high = (
        min(max(soft.k_position * (bound - position), -most), most)
        for bound in (soft.lower, soft.upper)
    )
    return low, high
