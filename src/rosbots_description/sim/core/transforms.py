"""Rigid poses as plain tuples: position (x, y, z) [m], orientation quaternion (x, y, z, w).

Tuples of floats, not arrays: a pose has seven numbers, and at that size plain arithmetic is
several times faster than numpy. With T_ab the pose of frame b in frame a,
`compose(T_ab, T_bc)` is T_ac, `relative(T_ac, T_ab)` is T_bc and `inverse(T_ab)` is T_ba.
"""

import math
from collections.abc import Iterable
from typing import NamedTuple

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]

ZERO: Vector = (0.0, 0.0, 0.0)
UP: Vector = (0.0, 0.0, 1.0)
NO_ROTATION: Quaternion = (0.0, 0.0, 0.0, 1.0)
ALONG = 0.999  # cosine of the angle to an axis; a direction above it counts as that axis

_SMALL, _LARGE = 1e-150, 1e150  # between these, squares neither underflow nor overflow


class Pose(NamedTuple):
    """Position [m] and orientation, a unit quaternion (x, y, z, w)."""

    position: Vector = ZERO
    orientation: Quaternion = NO_ROTATION


class Twist(NamedTuple):
    """Linear [m/s] and angular [rad/s] velocity."""

    linear: Vector = ZERO
    angular: Vector = ZERO


IDENTITY = Pose()


def as_vector(numbers: Iterable[float]) -> Vector:
    """Return three numbers, numpy's too, as a vector."""
    x, y, z = numbers
    return (float(x), float(y), float(z))


def as_quaternion(numbers: Iterable[float]) -> Quaternion:
    """Return four numbers (x, y, z, w), numpy's too, as a quaternion."""
    x, y, z, w = numbers
    return (float(x), float(y), float(z), float(w))


def add(a: Vector, b: Vector) -> Vector:
    """Return a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def subtract(a: Vector, b: Vector) -> Vector:
    """Return a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a: Vector, b: Vector) -> float:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Return the vector product a x b."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def normalise(q: Quaternion) -> Quaternion:
    """Return `q` normalised to unit length; all zeros mean no rotation, as in Gazebo."""
    length = _length(q)
    if not _SMALL < length < _LARGE:
        largest = max(map(abs, q))
        if largest == 0.0:
            return NO_ROTATION
        q = as_quaternion(part / largest for part in q)
        length = _length(q)
    return (q[0] / length, q[1] / length, q[2] / length, q[3] / length)


def _length(q: Quaternion) -> float:
    return math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])


def conjugate(q: Quaternion) -> Quaternion:
    """Return the inverse rotation of the unit quaternion `q`."""
    return (-q[0], -q[1], -q[2], q[3])


def multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the rotation `b` followed by `a` (Hamilton product a * b)."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def rotate(q: Quaternion, v: Vector) -> Vector:
    """Return `v` rotated by the unit quaternion `q`."""
    x, y, z, w = q
    tx = 2.0 * (y * v[2] - z * v[1])
    ty = 2.0 * (z * v[0] - x * v[2])
    tz = 2.0 * (x * v[1] - y * v[0])
    return (
        v[0] + w * tx + y * tz - z * ty,
        v[1] + w * ty + z * tx - x * tz,
        v[2] + w * tz + x * ty - y * tx,
    )


def compose(frame: Pose, pose: Pose) -> Pose:
    """Return `pose`, given in `frame`, in the parent frame of `frame`."""
    return Pose(
        add(frame.position, rotate(frame.orientation, pose.position)),
        multiply(frame.orientation, pose.orientation),
    )


def inverse(pose: Pose) -> Pose:
    """Return the inverse of `pose`: compose(pose, inverse(pose)) is the identity."""
    back = conjugate(pose.orientation)
    x, y, z = rotate(back, pose.position)
    return Pose((-x, -y, -z), back)


def relative(pose: Pose, frame: Pose) -> Pose:
    """Return `pose` relative to `frame`, both given in the same frame."""
    return compose(inverse(frame), pose)


def from_rpy(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Return the rotation about the fixed axes x, y, z by roll, pitch, yaw [rad] (REP-103)."""
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def to_rpy(q: Quaternion) -> Vector:
    """Return roll, pitch, yaw [rad] of the unit quaternion `q`; pitch within +-pi/2."""
    x, y, z, w = q
    sin_pitch = max(-1.0, min(1.0, 2.0 * (w * y - z * x)))
    return (
        math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        math.asin(sin_pitch),
        yaw_of(q),
    )


def yaw_of(q: Quaternion) -> float:
    """Return the rotation about z [rad] of the unit quaternion `q`."""
    x, y, z, w = q
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
