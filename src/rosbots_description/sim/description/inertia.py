"""Mass properties: put them together, turn them to their principal axes, keep them turnable."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..core import (
    IDENTITY,
    NO_ROTATION,
    Pose,
    Quaternion,
    Vector,
    as_quaternion,
    as_vector,
    compose,
    normalise,
    rotate,
)
from ..core.arrays import FloatArray
from .model_spec import REVOLUTE, Inertial, JointSpec, LinkSpec

# A body without any resistance to turning cannot be simulated. It gets that of a solid ball of
# this radius [m] about the axes in question.
STAND_IN_RADIUS = 0.1

# By how much of itself the greatest principal moment may exceed the sum of the others: so much does
# that of a flat plate if two digits are written, each number being off by up to a twentieth.
ROUNDING = 0.1

# Significant digits that every linear algebra library agrees on.
_DIGITS = 12

# A moment smaller than this, in parts of the greatest, is zero but for rounding.
_NEARLY_ZERO = 1e-9
# Share of its moment about an axis, by which a wheel may be out of balance.
_UNEVEN = 0.02

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
    return as_vector(settle(moments)), normalise(turned.orientation)


def settle(values: FloatArray) -> FloatArray:
    """Return `values` without the digits that depend on the machine's linear algebra library.

    What is left is the same on every machine, and so is the motion that follows from it.
    """
    largest = float(np.max(np.abs(values)))
    if largest == 0.0:
        return values
    return np.round(values, _DIGITS - math.ceil(math.log10(largest))) + 0.0


def tensor(inertial: Inertial) -> FloatArray:
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
        mass, Pose(as_vector(centre)),
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


def possible(inertial: Inertial) -> Inertial:
    """Return `inertial` with the nearest tensor that a body can have; unchanged where it is one.

    The principal moments of a body are sums of two of its second moments, J1 = s2 + s3 and so on,
    s >= 0; so none is greater than the other two together. Nearest is meant in the Frobenius norm:
    the axes stay, and the moments are projected onto the cone of those sums. A tensor that fails by
    no more than ROUNDING of its greatest moment is that of a body, written with few digits.
    """
    moments, axes = np.linalg.eigh(tensor(inertial))
    greatest = max(map(abs, moments))
    negative = moments[0] < -_NEARLY_ZERO * greatest
    if not negative and 2.0 * greatest - sum(moments) <= ROUNDING * greatest:
        return inertial
    nearest = settle(axes @ np.diag(_sums_of_two(moments)) @ axes.T)
    return replace(
        inertial,
        ixx=float(nearest[0, 0]), iyy=float(nearest[1, 1]), izz=float(nearest[2, 2]),
        ixy=float(nearest[0, 1]), ixz=float(nearest[0, 2]), iyz=float(nearest[1, 2]),
    )


def impossible(link: str, given: Inertial, used: Inertial) -> str:
    """Return the sentence to warn with where `possible` has changed a link's tensor."""
    return (
        f"link '{link}': no body has the inertia {_shown(given)} [kg m^2], as a principal moment "
        'is greater than the other two together, or negative; the nearest that a body can have is '
        f'used: {_shown(used)}'
    )


def _shown(inertial: Inertial) -> str:
    return ' '.join(
        f'{key}={getattr(inertial, key):.6g}' for key in ('ixx', 'iyy', 'izz', 'ixy', 'ixz', 'iyz')
    )


def _sums_of_two(moments: FloatArray) -> FloatArray:
    """Return the point nearest to `moments` among sums of two of three numbers that are >= 0.

    Of the three numbers some are zero, and the others solve a least-squares problem (Karush, Kuhn
    and Tucker); there are seven ways to choose them.
    """
    sums, best = np.ones((3, 3)) - np.eye(3), np.zeros(3)
    for chosen in ([0], [1], [2], [0, 1], [0, 2], [1, 2], [0, 1, 2]):
        numbers = np.linalg.lstsq(sums[:, chosen], moments, rcond=None)[0]
        point = sums[:, chosen] @ np.maximum(numbers, 0.0)
        if np.linalg.norm(point - moments) < np.linalg.norm(best - moments):
            best = point
    return best


def turnable(inertial: Inertial) -> Inertial:
    """Return `inertial` with each zero principal moment replaced by that of a small solid ball.

    2/5 m r^2 with r = STAND_IN_RADIUS. An inertial that can turn is returned unchanged.
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
    return min(moments) >= -_NEARLY_ZERO * max(abs(moment) for moment in moments)


def is_balanced(inertial: Inertial, joint: JointSpec) -> bool:
    """Tell whether a link has its mass evenly about the axis of a joint, as a wheel has."""
    if joint.type != REVOLUTE:
        return False
    axis = np.array(joint.axis_in_child)
    arm = np.cross(np.array(inertial.pose.position) - joint.pose.position, axis)
    turn = _matrix(inertial.pose.orientation)
    whole = turn @ tensor(inertial) @ turn.T
    along = axis @ whole @ axis
    # Seen along the axis a balanced tensor is a circle, and does not lean to the axis.
    flat = whole - along * np.outer(axis, axis)
    uneven = flat - 0.5 * np.trace(flat) * (np.eye(3) - np.outer(axis, axis))
    return float(inertial.mass * arm @ arm + np.linalg.norm(uneven)) <= _UNEVEN * float(along)


def _nearest_order(axes: FloatArray) -> list[int]:
    """Return which column of `axes` to use as x, y and z: the one that points there most."""
    order: list[int] = []
    for row in np.abs(axes):
        free = [i for i in range(3) if i not in order]
        order.append(max(free, key=lambda i: row[i]))
    return order


def mobility(link: LinkSpec, place: Vector, turn: Quaternion) -> FloatArray:
    """Return how a free link answers a wrench at a place (6x6): turning and moving, in its axes.

    Both are in the frame of the link's model; so are the place [m], and what turns the link about
    it.
    """
    inertial = link.mass_properties
    com = compose(link.pose, inertial.pose)
    axes = _matrix(turn) @ _matrix(com.orientation)
    loose = axes @ np.linalg.inv(tensor(inertial)) @ axes.T
    x, y, z = _matrix(turn) @ np.subtract(com.position, place)
    arm = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.block([
        [loose, -loose @ arm], [arm @ loose, np.eye(3) / inertial.mass - arm @ loose @ arm],
    ])


def _matrix(q: Quaternion) -> FloatArray:
    if q == NO_ROTATION:
        return np.eye(3)
    return np.array([rotate(q, axis) for axis in np.eye(3).tolist()]).T


def _quaternion(matrix: FloatArray) -> Quaternion:
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
    return normalise(as_quaternion(q))
