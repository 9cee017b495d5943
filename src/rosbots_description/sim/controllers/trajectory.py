"""Trajectories of joints: points, tolerances, and the splines between the points.

As in joint_trajectory_controller 0.22, two points with velocities are joined by a cubic, with
accelerations too by a quintic, and otherwise by a line.
"""

import math
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, NamedTuple

from .angles import shortest

MOST = 1e9  # of the numbers in a trajectory, so that no polynomial overflows
_INSTANT = 1e-9  # [s] below which a segment has no duration
_AT_PI = 1e-9  # [rad] from half a turn, within which the direction is that of the numbers


class TrajectoryPoint(NamedTuple):
    """Positions [rad or m], and what is given of velocities and accelerations, after a time [s]."""

    positions: Sequence[float]
    velocities: Sequence[float] = ()
    accelerations: Sequence[float] = ()
    time_from_start: float = 0.0
    efforts: Sequence[float] = ()  # [N m or N], in states only


class TrajectoryState(NamedTuple):
    """Desired and actual state of the joints, and the difference; what is not known is empty."""

    joint_names: Sequence[str]
    desired: TrajectoryPoint
    actual: TrajectoryPoint
    error: TrajectoryPoint


class Tolerance(NamedTuple):
    """Largest permitted errors; 0 for no limit."""

    position: float = 0.0
    velocity: float = 0.0
    acceleration: float = 0.0

    def replaced_by(self, other: 'Tolerance') -> 'Tolerance':
        """Return this with the values of `other`; there, 0 keeps a value and < 0 removes it."""
        return Tolerance(
            *(max(0.0, new) if new else old for old, new in zip(self, other, strict=True))
        )

    def permits(self, position: float, velocity: float) -> bool:
        """Tell whether errors are permitted; the acceleration of a joint is not known."""
        return not (
            (self.position > 0.0 and abs(position) > self.position)
            or (self.velocity > 0.0 and abs(velocity) > self.velocity)
        )


class Tolerances(NamedTuple):
    """Tolerances of a joint on the path and at the end, and the time that it may be late [s]."""

    path: Tolerance = Tolerance()
    goal: Tolerance = Tolerance()
    goal_time: float = 0.0


@dataclass(frozen=True)
class Trajectory:
    """Points for joints to pass.

    `start_ns` is the simulated time at which it begins [ns]; 0 for now.
    """

    joint_names: Sequence[str]
    points: Sequence[TrajectoryPoint]
    start_ns: int = 0


@dataclass(frozen=True)
class TrajectoryGoal:
    """A trajectory to follow within tolerances, by joint; 0 for those of the controller."""

    trajectory: Trajectory
    path_tolerances: Mapping[str, Tolerance] = field(default_factory=dict)
    goal_tolerances: Mapping[str, Tolerance] = field(default_factory=dict)
    goal_time_tolerance: float = 0.0


class JointPoint(NamedTuple):
    """A point of one joint; None for what is not given."""

    position: float
    velocity: float | None = None
    acceleration: float | None = None


class SplineSegment(NamedTuple):
    """A polynomial from `start` to `end` [s]: position = sum of coefficients[i] * (t - start)^i.

    Attributes:
        time_from_start: of its first point in its trajectory [s].
        goal: that it belongs to, None for none.
    """

    start: float
    end: float
    coefficients: tuple[float, ...]
    time_from_start: float = 0.0
    goal: Any = None
    tolerances: Tolerances = Tolerances()

    def sample(self, time: float) -> tuple[float, float, float]:
        """Return position, velocity and acceleration; at rest before it begins and after it."""
        elapsed = time - self.start
        c0, c1, c2, c3, c4, c5 = self.coefficients
        if elapsed < 0.0:
            return c0, 0.0, 0.0
        length = self.end - self.start
        t = min(elapsed, length)
        position = c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * c5))))
        if elapsed > length:
            return position, 0.0, 0.0
        return (
            position,
            c1 + t * (2.0 * c2 + t * (3.0 * c3 + t * (4.0 * c4 + t * 5.0 * c5))),
            2.0 * c2 + t * (6.0 * c3 + t * (12.0 * c4 + t * 20.0 * c5)),
        )


def coefficients(start: JointPoint, end: JointPoint, time: float) -> tuple[float, ...]:
    """Return the coefficients of the polynomial between two points, `time` [s] apart."""
    p0, v0, a0 = start
    p1, v1, a1 = end
    is_instant = time < _INSTANT
    if v0 is None or v1 is None:
        return (p0, 0.0 if is_instant else (p1 - p0) / time, 0.0, 0.0, 0.0, 0.0)
    if a0 is None or a1 is None:
        if is_instant:
            return (p0, v0, 0.0, 0.0, 0.0, 0.0)
        way = p1 - p0
        return (
            p0,
            v0,
            (3.0 * way / time - 2.0 * v0 - v1) / time,
            (v0 + v1 - 2.0 * way / time) / time**2,
            0.0,
            0.0,
        )
    if is_instant:
        return (p0, v0, a0 / 2.0, 0.0, 0.0, 0.0)
    # What is left of the way, the velocity and the acceleration after a parabola from the start.
    way = (p1 - p0 - v0 * time - a0 * time**2 / 2.0) / time**3
    speed = (v1 - v0 - a0 * time) / time**2
    rest = (a1 - a0) / time
    return (
        p0,
        v0,
        a0 / 2.0,
        10.0 * way - 4.0 * speed + rest / 2.0,
        (-15.0 * way + 7.0 * speed - rest) / time,
        (6.0 * way - 3.0 * speed + rest / 2.0) / time**2,
    )


def active(segments: Sequence[SplineSegment], time: float) -> int:
    """Return the index of the last segment that has begun; -1 if none has."""
    return bisect_right(segments, time, key=_start) - 1


def _start(segment: SplineSegment) -> float:
    return segment.start


def unwrapped(before: float, position: float) -> float:
    """Return the angle equal to `position` that is closest to `before` [rad]."""
    way = shortest(before, position)
    if abs(abs(way) - math.pi) < _AT_PI:
        way = math.copysign(way, position - before)
    return before + way


def joint_point(point: TrajectoryPoint, index: int, offset: float) -> JointPoint:
    """Return a joint's part of a point, with its position moved by `offset`."""
    return JointPoint(
        point.positions[index] + offset,
        point.velocities[index] if point.velocities else None,
        point.accelerations[index] if point.accelerations else None,
    )


def check_points(trajectory: Trajectory) -> None:
    """Reject a trajectory that cannot be followed.

    Raises:
        ValueError: points are not in the order of time, have another size than the joints, lack
            positions, or have numbers that are not finite or beyond MOST.
    """
    times = [point.time_from_start for point in trajectory.points]
    numbers = [number for point in trajectory.points for series in point[:3] for number in series]
    if not all(map(math.isfinite, (*numbers, *times))):
        raise ValueError('Trajectory message contains a number that is not finite.')
    if any(abs(number) > MOST for number in (*numbers, *times)):
        raise ValueError(f'Trajectory message contains a number beyond {MOST:g}.')
    if any(later <= sooner for sooner, later in pairwise(times)):
        raise ValueError(
            'Trajectory message contains waypoints that are not strictly increasing in time.'
        )
    if not all(point.positions for point in trajectory.points):
        raise ValueError(
            "Quintic spline segment can't be constructed: Endpoint positions can't be empty."
        )
    count = len(trajectory.joint_names)
    if any(series and len(series) != count for point in trajectory.points for series in point[:3]):
        raise ValueError(
            'Size mismatch in trajectory point position, velocity or acceleration data.'
        )
