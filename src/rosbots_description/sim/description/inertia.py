"""Mass properties: merge them, diagonalise them, and replace what a body cannot have."""

import math
from collections.abc import Sequence

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
)
from ..core.arrays import FloatArray, rotation_matrix
from .model_spec import REVOLUTE, Inertial, JointSpec, LinkSpec

# A body with a zero principal moment cannot be simulated. It gets that of a solid sphere of this
# radius [m] about the axes in question.
STAND_IN_RADIUS = 0.1

# Relative amount by which the greatest principal moment may exceed the sum of the other two. A flat
# plate written with two digits does: each number is off by up to a twentieth.
ROUNDING = 0.1

# Significant digits on which all linear algebra libraries agree.
_DIGITS = 12

# A moment smaller than this fraction of the greatest is zero up to rounding.
_NEARLY_ZERO = 1e-9
# Imbalance that a wheel may have, as a fraction of its moment about the axis.
_UNEVEN = 0.02

# Principal moments below this [m^2], times the mass, count as zero.
_ZERO_RADIUS_SQUARED = 1e-12


def principal_axes(inertial: Inertial) -> tuple[Vector, Quaternion]:
    """Return the principal moments [kg m^2] and the orientation of their axes in the link's frame.

    A diagonal tensor keeps the axes of `inertial.pose`, in their order. Other tensors get
    right-handed axes, each as close as possible to the old one, so that equal input gives equal
    output and small off-diagonal terms give small rotations.
    """
    own = inertial.pose.orientation
    if inertial.ixy == 0.0 and inertial.ixz == 0.0 and inertial.iyz == 0.0:
        return (inertial.ixx, inertial.iyy, inertial.izz), own
    moments, axes = np.linalg.eigh(tensor(inertial))
    order = _nearest_order(axes)
    moments, axes = moments[order], axes[:, order]
    # Right-handed: else a00 = a12 a21 - a11 a22 <= a12 a21, which a00 >= 1/sqrt(3), the greatest of
    # its row, and |a12| <= a11 exclude.
    axes = axes * np.where(np.diag(axes) < 0.0, -1.0, 1.0)
    turned = compose(Pose(orientation=own), Pose(orientation=_quaternion(rounded(axes))))
    return as_vector(rounded(moments)), normalise(turned.orientation)


def rounded(values: FloatArray) -> FloatArray:
    """Return `values` rounded to the digits on which all linear algebra libraries agree.

    They are then the same on every machine, and so is the simulated motion.
    """
    largest = float(np.max(np.abs(values)))
    if largest == 0.0:
        return values
    return np.round(values, _DIGITS - math.ceil(math.log10(largest))) + 0.0


def tensor(inertial: Inertial) -> FloatArray:
    """Return the 3x3 inertia tensor about the centre of mass, in the axes of `inertial.pose`."""
    return np.array(
        [
            [inertial.ixx, inertial.ixy, inertial.ixz],
            [inertial.ixy, inertial.iyy, inertial.iyz],
            [inertial.ixz, inertial.iyz, inertial.izz],
        ]
    )


def _with_tensor(mass: float, pose: Pose, full: FloatArray) -> Inertial:
    """Return mass properties with a tensor (3, 3) in the axes of `pose`."""
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = full.tolist()
    return Inertial(mass, pose, ixx, iyy, izz, ixy, ixz, iyz)


def merge(parts: Sequence[tuple[Pose, Inertial]]) -> Inertial:
    """Return the mass properties of rigidly connected parts (parallel axis theorem).

    Args:
        parts: for each part the pose of its link in the common frame, and its inertial; masses
            are greater than zero. A single part at the identity is returned unchanged.

    Returns:
        The sum, with its tensor in the axes of the common frame.
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
    return _with_tensor(round(mass, _DIGITS), Pose(as_vector(rounded(centre))), rounded(total))


def in_link_axes(inertial: Inertial) -> Inertial:
    """Return the same mass properties with the tensor in the axes of the link."""
    turn = _matrix(inertial.pose.orientation)
    total = rounded(turn @ tensor(inertial) @ turn.T)
    return _with_tensor(inertial.mass, Pose(inertial.pose.position), total)


def possible(inertial: Inertial) -> Inertial:
    """Return `inertial` with the nearest physically possible tensor; unchanged if it is one.

    Principal moments are sums of two second moments, J1 = s2 + s3 and so on, with s >= 0; hence the
    triangle inequality J1 <= J2 + J3. Nearest is meant in the Frobenius norm: the axes stay, and
    the moments are projected onto the cone of those sums. A violation of at most ROUNDING of the
    greatest moment is accepted, as it comes from writing few digits.
    """
    moments, axes = np.linalg.eigh(tensor(inertial))
    greatest = max(map(abs, moments))
    negative = moments[0] < -_NEARLY_ZERO * greatest
    if not negative and 2.0 * greatest - sum(moments) <= ROUNDING * greatest:
        return inertial
    nearest = rounded(axes @ np.diag(_sums_of_two(moments)) @ axes.T)
    return _with_tensor(inertial.mass, inertial.pose, nearest)


def impossible(link: str, given: Inertial, used: Inertial) -> str:
    """Return the warning for a link whose tensor `possible` has changed."""
    return (
        f"link '{link}': the inertia {_shown(given)} [kg m^2] is physically impossible: "
        'a principal moment is negative or greater than the sum of the other two; '
        f'the nearest possible tensor is used: {_shown(used)}'
    )


def _shown(inertial: Inertial) -> str:
    return ' '.join(
        f'{key}={getattr(inertial, key):.6g}' for key in ('ixx', 'iyy', 'izz', 'ixy', 'ixz', 'iyz')
    )


def _sums_of_two(moments: FloatArray) -> FloatArray:
    """Return the point (s2 + s3, s1 + s3, s1 + s2), all s >= 0, nearest to `moments`.

    By the Karush-Kuhn-Tucker conditions some s are zero and the others solve a least-squares
    problem. The moments are ascending, so the s are descending, and the last ones are zero.
    """
    sums, best = np.ones((3, 3)) - np.eye(3), np.zeros(3)
    for count in (1, 2, 3):
        numbers = np.linalg.lstsq(sums[:, :count], moments, rcond=None)[0]
        point = sums[:, :count] @ np.maximum(numbers, 0.0)
        if np.linalg.norm(point - moments) < np.linalg.norm(best - moments):
            best = point
    return best


def regularised(inertial: Inertial) -> Inertial:
    """Return `inertial` with each zero principal moment replaced by that of a small solid sphere.

    2/5 m r^2 with r = STAND_IN_RADIUS. Other inertials are returned unchanged.
    """
    moments, axes = principal_axes(inertial)
    zero = _ZERO_RADIUS_SQUARED * inertial.mass
    if min(moments) > zero:
        return inertial
    ball = 0.4 * inertial.mass * STAND_IN_RADIUS**2
    ixx, iyy, izz = (moment if moment > zero else ball for moment in moments)
    return Inertial(inertial.mass, Pose(inertial.pose.position, axes), ixx, iyy, izz)


def is_positive(inertial: Inertial) -> bool:
    """Tell whether no principal moment is negative, up to rounding."""
    moments, _ = principal_axes(inertial)
    return min(moments) >= -_NEARLY_ZERO * max(abs(moment) for moment in moments)


def is_balanced(inertial: Inertial, joint: JointSpec) -> bool:
    """Tell whether a link is balanced about the axis of a joint, as a wheel is."""
    if joint.type != REVOLUTE:
        return False
    axis = np.array(joint.axis_in_child)
    arm = np.cross(np.array(inertial.pose.position) - joint.pose.position, axis)
    turn = _matrix(inertial.pose.orientation)
    whole = turn @ tensor(inertial) @ turn.T
    along = axis @ whole @ axis
    # A balanced tensor has the axis as a principal axis, and equal moments across it.
    flat = whole - along * np.outer(axis, axis)
    uneven = flat - 0.5 * np.trace(flat) * (np.eye(3) - np.outer(axis, axis))
    return float(inertial.mass * arm @ arm + np.linalg.norm(uneven)) <= _UNEVEN * float(along)


def _nearest_order(axes: FloatArray) -> list[int]:
    """Return which column of `axes` to use as x, y and z: the most closely aligned one."""
    order: list[int] = []
    for row in np.abs(axes):
        free = [i for i in range(3) if i not in order]
        order.append(max(free, key=lambda i: row[i]))
    return order


def mobility(link: LinkSpec, place: Vector, turn: Quaternion) -> FloatArray:
    """Return the inverse inertia (6x6) of a free link at a point: wrench to spatial acceleration.

    Angular parts come first. All is in the axes of the model's frame, after the link was rotated
    about the point [m] by `turn`.
    """
    inertial = link.mass_properties
    com = compose(link.pose, inertial.pose)
    axes = _matrix(turn) @ _matrix(com.orientation)
    loose = axes @ np.linalg.inv(tensor(inertial)) @ axes.T
    x, y, z = _matrix(turn) @ np.subtract(com.position, place)
    arm = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.block(
        [
            [loose, -loose @ arm],
            [arm @ loose, np.eye(3) / inertial.mass - arm @ loose @ arm],
        ]
    )


def _matrix(q: Quaternion) -> FloatArray:
    return np.eye(3) if q == NO_ROTATION else rotation_matrix(q)


def _quaternion(m: FloatArray) -> Quaternion:
    """Return the rotation (x, y, z, w) of an orthonormal right-handed matrix with a trace above 0.

    4 w^2 = 1 + trace; the first three are 4 w (x, y, z).
    """
    return normalise(
        as_quaternion((m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], 1.0 + np.trace(m)))
    )
