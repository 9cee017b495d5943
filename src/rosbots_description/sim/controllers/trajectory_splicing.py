"""How a trajectory replaces the rest of the one before, as joint_trajectory_controller 0.22 does.

Times are in seconds since the controller was started.
"""

from collections.abc import Sequence

from ..core import Fault, report
from .errors import ControllerError
from .goal import Goal
from .trajectory import (
    JointPoint,
    SplineSegment,
    Tolerances,
    Trajectory,
    TrajectoryPoint,
    active,
    coefficients,
    joint_point,
    unwrapped,
)

Segments = list[SplineSegment]  # of one joint, in the order of time


def points_to_come(trajectory: Trajectory, start: float, now: float) -> Sequence[TrajectoryPoint]:
    """Return the points of a trajectory from `start` on that are after the time `now`.

    Raises:
        ControllerError: all of them are in the past.
    """
    points = trajectory.points
    past = sum(start + point.time_from_start <= now for point in points)
    if past == len(points):
        late = now - (start + points[-1].time_from_start)
        raise ControllerError(
            f'Dropping all {past} trajectory point(s), as they occur before the current time.\n'
            f'Last point is {late:.6f}s in the past.'
        )
    starts_at_zero = past == 1 and not (trajectory.start_ns or points[0].time_from_start)
    if past and not starts_at_zero:
        left = start + points[past].time_from_start - now
        what = (
            f'Dropping first {past} trajectory point(s) out of {len(points)}, as they occur before '
            f'the current time.\nFirst valid point will be reached in {left:.3f}s.'
        )
        report(Fault(what))
    return points[past:]


def rest_of(segments: Segments, now: float, goal: Goal | None) -> Segments:
    """Return what is left of a trajectory, which from now on counts for another goal."""
    return [segment._replace(goal=goal) for segment in segments[max(0, active(segments, now)) :]]


def spliced(
    rest: Segments,
    points: Sequence[TrajectoryPoint],
    index: int,
    wraps: bool,
    start: float,
    now: float,
    goal: Goal | None,
    tolerances: Tolerances,
) -> Segments:
    """Return the trajectory of a joint: what is left of one, a bridge, and new points.

    Args:
        index: of the joint in the points.
        wraps: whether it turns without limits, so that the shorter way is taken.
        start: when the new trajectory starts, maybe before `now`, the time of the next update.
        tolerances: of the new part.
    """
    last = max(start, now)
    segments = rest[: active(rest, last) + 1]
    before = JointPoint(*(segments[-1] if segments else rest[0]).sample(last))
    first = points[0].positions[index]
    offset = unwrapped(before.position, first) - first if wraps else 0.0
    time, from_start = last, 0.0
    for point in points:
        after, end = joint_point(point, index, offset), start + point.time_from_start
        segments.append(
            SplineSegment(
                time, end, coefficients(before, after, end - time), from_start, goal, tolerances
            )
        )
        before, time, from_start = after, end, point.time_from_start
    return segments
