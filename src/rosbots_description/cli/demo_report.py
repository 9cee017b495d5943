"""Measurements of the demo, as numbers and as a table. Poses are in the world frame."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

from ..ros_api.clients.planar_sample import PlanarSample

# Actual geometry, and that configured in the robot's plugin [m].
_WHEEL_RADIUS, _WHEEL_RADIUS_TOLD = 0.23, 0.26
_TRACK, _TRACK_TOLD = 0.88, 1.1

#: Ratio of ground speed to commanded speed without slip.
SPEED_RATIO = _WHEEL_RADIUS / _WHEEL_RADIUS_TOLD
#: Ratio of turn rate to commanded turn rate without slip.
TURN_RATIO = SPEED_RATIO * _TRACK_TOLD / _TRACK

SETTLING = 1.0  # [s] simulated; the ramp to 0.5 m/s takes 0.46 s, the one to 1 rad/s 0.5 s

# Slip of wheels and caster takes up to 6 % in the arc and 3 % elsewhere; a wrong sign, a wrong
# wheel or a robot that stands still differ by far more.
_SPEED_TOLERANCE = 0.06  # [m/s]
_TURN_TOLERANCE = 0.12  # [rad/s]


@dataclass(frozen=True)
class Segment:
    """One part of the drive: a constant command for some time."""

    name: str
    speed: float  # [m/s] along the robot's x, as commanded
    turn_rate: float  # [rad/s] counter-clockwise, as commanded
    duration: float  # [s] simulated, longer than SETTLING


DRIVE = (
    Segment('straight', 0.5, 0.0, 3.0),
    Segment('arc', 0.5, 0.5, 3.5),
    Segment('turn', 0.0, 1.0, 2.5),
    Segment('stop', 0.0, 0.0, 2.0),
)


@dataclass(frozen=True)
class MeanMotion:
    """Mean velocity in the robot's frame."""

    speed: float  # [m/s] along x
    turn_rate: float  # [rad/s] counter-clockwise


@dataclass(frozen=True)
class Row:
    """A segment of the drive and its measured motion."""

    segment: Segment
    odometry: MeanMotion
    truth: MeanMotion
    real_time_factor: float


def steady_motion(samples: Sequence[PlanarSample]) -> MeanMotion:
    """Return the mean velocity once SETTLING has passed since the first sample.

    Raises:
        ValueError: fewer than two samples are left.
    """
    steady = [sample for sample in samples if sample.stamp >= samples[0].stamp + SETTLING]
    if len(steady) < 2 or steady[-1].stamp <= steady[0].stamp:
        raise ValueError(f'{len(steady)} of {len(samples)} samples lie after {SETTLING} s')
    path = turned = 0.0
    for before, after in itertools.pairwise(steady):
        step = math.remainder(after.yaw - before.yaw, math.tau)
        # the chord of an arc points along the mean of the headings at its ends
        heading = before.yaw + step / 2
        path += (after.x - before.x) * math.cos(heading) + (after.y - before.y) * math.sin(heading)
        turned += step
    time = steady[-1].stamp - steady[0].stamp
    return MeanMotion(path / time, turned / time)


def real_time_factor(samples: Sequence[PlanarSample]) -> float:
    """Return the ratio of simulated to wall time over the samples (two or more)."""
    first, last = samples[0], samples[-1]
    return (last.stamp - first.stamp) / (last.wall - first.wall)


def expected_motion(segment: Segment) -> MeanMotion:
    """Return the velocity for the actual geometry without slip."""
    return MeanMotion(SPEED_RATIO * segment.speed, TURN_RATIO * segment.turn_rate)


def complaint(row: Row) -> str | None:
    """Return a sentence if the robot did not move as commanded, else None."""
    expected, truth = expected_motion(row.segment), row.truth
    if (
        abs(truth.speed - expected.speed) <= _SPEED_TOLERANCE
        and abs(truth.turn_rate - expected.turn_rate) <= _TURN_TOLERANCE
    ):
        return None
    return (
        f'in the part "{row.segment.name}" the robot moved at {truth.speed:.3f} m/s and '
        f'{truth.turn_rate:.3f} rad/s, but its wheels should give {expected.speed:.3f} m/s and '
        f'{expected.turn_rate:.3f} rad/s'
    )


def table(rows: Sequence[Row]) -> str:
    """Return the measurements as text, one line for each segment."""
    lines = [
        f'{"":17}{"commanded":>16}{"odometry":>18}{"ground truth":>18}{"real-time":>12}',
        f'{"part":9}{"time":>8}'
        + f'{"m/s":>8}{"rad/s":>8}'
        + f'{"m/s":>10}{"rad/s":>8}' * 2
        + f'{"factor":>12}',
    ]
    for row in rows:
        segment = row.segment
        lines.append(
            f'{segment.name:9}{segment.duration:6.1f} s'
            f'{segment.speed:8.2f}{segment.turn_rate:8.2f}'
            + ''.join(
                f'{_rounded(motion.speed):10.3f}{_rounded(motion.turn_rate):8.3f}'
                for motion in (row.odometry, row.truth)
            )
            + f'{row.real_time_factor:12.3f}'
        )
    return '\n'.join(lines)


def _rounded(value: float) -> float:
    """Round to the digits of the table, without a negative zero."""
    return round(value, 3) + 0.0
