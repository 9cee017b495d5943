"""Mass properties: put them together, turn them to their principal axes, keep them turnable."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .pose import IDENTITY, NO_ROTATION, Pose, Quaternion, Vector, compose, normalise, rotate
from .spec import Inertial

# A body without any resistance to turning cannot be simulated. It gets that of a solid ball of
# this radius [m] about the axes in question.
STAND_IN_RADIUS = 0.1

# Significant digits that every linear algebra library agrees on.
_DIGITS = 12

# Principal moments below this [m^2], times the mass, count as zero.
_ZERO_RADIUS_SQUARED = 1e-12


def principal_axes(inertial: Inertial) -> tuple[Vector, Quaternion]:
    """Return the principal moments [kg m^2] and the orientation of their axes in the link's frame.

    A tensor that is diagonal already keeps the axes of `inertial.pose`, in their order. The
    others get right-handed axes, each as near as can be to the old one, so that equal input gives
    equal output and small off-diagonal terms give small turns.
    """
    own = inertial.pose.orientation
    if inertial.ixy == 0.0 and inertial.ixz == 0.0 and inertial.iyz == 0.0:
        return (inertial.ixx, inertial.iyy, inertial.izz), own
    moments, axes = np.linalg.eigh(tensor(inertial))
    order = _nearest_order(axes)
    moments, axes = moments[order], axes[:, order]
    axes = axes * np.where(np.diag(axes) < 0.0, -1.0, 1.0)
    if np.linalg.det(axes) < 0.0:
        axes[:, np.argmin(np.abs(np.diag(axes)))] *= -1.0
    turned = compose(Pose(orientation=own), Pose(orientation=_quaternion(settle(axes))))
    return tuple(float(moment) for moment in settle(moments)), normalise(turned.orientation)


def settle(values: np.ndarray) -> np.ndarray:
    """Return `values` without the digits that depend on the machine's linear algebra library.

    What is left is the same on every machine, and so is the motion that follows from it.
    """
    largest = float(np.max(np.abs(values)))
    if largest == 0.0:
        return values
    return np.round(values, _DIGITS - math.ceil(math.log10(largest))) + 0.0


def tensor(inertial: Inertial) -> np.ndarray:
    """Return the 3x3 inertia tensor about the centre of mass, in the axes of `inertial.pose`."""
    return np.array([
        [inertial.ixx, inertial.ixy, inertial.ixz],
        [inertial.ixy, inertial.iyy, inertial.iyz],
        [inertial.ixz, inertial.iyz, inertial.izz],
    ])


def merge(parts: Sequence[tuple[Pose, Inertial]]) -> Inertial:
    """Return the mass properties of parts that move as one (parallel axis theorem).

    Args:
        parts: for each part the pose of its link in the common frame, and its inertial; the
            masses are greater than zero. A single part in place is returned as it is.

    Returns:
        The sum, its tensor in the axes of the common frame.
    """
    if len(parts) == 1 and parts[0][0] == IDENTITY:
        return parts[0][1]
    poses = [compose(frame, inertial.pose) for frame, inertial in parts]
    masses = np.array([inertial.mass for _, inertial in parts])
    centres = np.array([pose.position for pose in poses])
    mass = float(masses.sum())
    centre = masses @ centres / mass
    total = np.zeros((3, 3))
    for pose, (_, inertial) in zip(poses, parts, strict=True):
        turn = _matrix(pose.orientation)
        arm = np.array(pose.position) - centre
        total += turn @ tensor(inertial) @ turn.T
        total += inertial.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    mass, centre, total = round(mass, _DIGITS), settle(centre), settle(total)
    return Inertial(
        mass, Pose(tuple(float(x) for x in centre)),
        ixx=float(total[0, 0]), iyy=float(total[1, 1]), izz=float(total[2, 2]),
        ixy=float(total[0, 1]), ixz=float(total[0, 2]), iyz=float(total[1, 2]),
    )


def in_link_axes(inertial: Inertial) -> Inertial:
    """Return the same mass properties with the tensor in the axes of the link."""
    turn = _matrix(inertial.pose.orientation)
    total = settle(turn @ tensor(inertial) @ turn.T)
    return Inertial(
        inertial.mass, Pose(inertial.pose.position),
        ixx=float(total[0, 0]), iyy=float(total[1, 1]), izz=float(total[2, 2]),
        ixy=float(total[0, 1]), ixz=float(total[0, 2]), iyz=float(total[1, 2]),
    )


def turnable(inertial: Inertial) -> Inertial:
    """Return `inertial` with each zero principal moment replaced by that of a small solid ball.

    2/5 m r^2 with r = STAND_IN_RADIUS. An inertial that can turn is returned unchanged, also
    where its tensor is one that no real body has.
    """
    moments, axes = principal_axes(inertial)
    zero = _ZERO_RADIUS_SQUARED * inertial.mass
    if min(moments) > zero:
        return inertial
    ball = 0.4 * inertial.mass * STAND_IN_RADIUS**2
    ixx, iyy, izz = (moment if moment > zero else ball for moment in moments)
    return replace(
        inertial, pose=Pose(inertial.pose.position, axes),
        ixx=ixx, iyy=iyy, izz=izz, ixy=0.0, ixz=0.0, iyz=0.0,
    )


def is_positive(inertial: Inertial) -> bool:
    """Tell whether no principal moment is negative (rounding apart)."""
    moments, _ = principal_axes(inertial)
    return min(moments) >= -1e-9 * max(abs(moment) for moment in moments)


def _nearest_order(axes: np.ndarray) -> list[int]:
    """Return which column of `axes` to use as x, y and z: the one that points there most."""
    order: list[int] = []
    for row in np.abs(axes):
        free = [i for i in range(3) if i not in order]
        order.append(max(free, key=lambda i: row[i]))
    return order


def _matrix(q: Quaternion) -> np.ndarray:
    if q == NO_ROTATION:
        return np.eye(3)
    return np.array([rotate(q, axis) for axis in np.eye(3).tolist()]).T


def _quaternion(matrix: np.ndarray) -> Quaternion:
    """Return the rotation (x, y, z, w) of an orthonormal right-handed matrix.

    The largest component is found first, so nothing is divided by something small (Shepperd 1978).
    """
    m = matrix
    trace = m[0, 0] + m[1, 1] + m[2, 2]
    squares = [m[0, 0], m[1, 1], m[2, 2], trace]
    largest = int(np.argmax(squares))
    q = np.empty(4)
    if largest == 3:
        q[:] = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], 1.0 + trace
    else:
        i, j, k = largest, (largest + 1) % 3, (largest + 2) % 3
        q[i] = 1.0 + 2.0 * m[i, i] - trace
        q[j], q[k] = m[j, i] + m[i, j], m[k, i] + m[i, k]
        q[3] = m[k, j] - m[j, k]
    return normalise(tuple(float(x) for x in q))
