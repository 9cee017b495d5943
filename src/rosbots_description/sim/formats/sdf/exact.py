"""What our world files have beyond SDF, in attributes that other programs ignore.

SDF gives rotations as roll, pitch and yaw, from which the last bits of a quaternion cannot be
computed. So a quaternion is written beside them. If someone changes the angles, these count.
"""

import math

from ...core import (
    Quaternion,
    Vector,
    as_quaternion,
    conjugate,
    from_rpy,
    multiply,
    parse_numbers,
    to_rpy,
)

NAMESPACE = 'urn:rosbots'
QUATERNION = f'{{{NAMESPACE}}}quaternion'  # of a <pose>: x y z w
REDUCED = f'{{{NAMESPACE}}}reduced'  # of a <frame>: a link that was merged into another one
EXACT = f'{{{NAMESPACE}}}exact'  # of a <state>: its velocities and joint angles count
AXES = f'{{{NAMESPACE}}}axes'  # of a <link> of a <state>: pose of its principal axes, x y z w
VELOCITY = f'{{{NAMESPACE}}}velocity'  # of a <joint> of a <state> [rad/s or m/s]
TARGET = f'{{{NAMESPACE}}}target'  # of the same: its motor's target velocity [rad/s or m/s]
EFFORT = f'{{{NAMESPACE}}}effort'  # of the same: its motor's greatest effort [N m or N], or inf

_SAME = 1e-6  # [rad] between the angles of a <pose> and its quaternion, at most


def angles_of(q: Quaternion) -> Vector:
    """Return roll, pitch, yaw [rad] of a unit quaternion, also where pitch is +-pi/2."""
    upright = math.copysign(math.pi / 2.0, q[3] * q[1] - q[2] * q[0])
    yaw = -2.0 * math.copysign(1.0, upright) * math.atan2(q[0], q[3])
    return min((to_rpy(q), (0.0, upright, yaw)), key=lambda rpy: angle_between(q, from_rpy(*rpy)))


def angle_between(one: Quaternion, other: Quaternion) -> float:
    """Return the angle [rad] of the rotation between two unit quaternions."""
    x, y, z, w = multiply(one, conjugate(other))
    return 2.0 * math.atan2(math.sqrt(x * x + y * y + z * z), abs(w))


def quaternion_text(q: Quaternion, rpy: Vector) -> str:
    """Return what `orientation` needs besides the angles [rad] to return `q` bit for bit, or ''."""
    return '' if from_rpy(*rpy) == q else ' '.join(map(repr, q))


def orientation(rpy: Vector, quaternion: str | None) -> Quaternion:
    """Return the orientation of a <pose>, by its angles [rad] and the quaternion beside them.

    The quaternion counts if it is one and means the same as the angles but for rounding.
    """
    turned = from_rpy(*rpy)
    exact = parse_numbers(quaternion, 4) if quaternion else None
    if exact is None or not angle_between(as_quaternion(exact), turned) < _SAME:
        return turned
    q = as_quaternion(exact)
    return q if is_unit(q) else turned


def is_unit(vector: tuple[float, ...]) -> bool:
    """Tell whether a vector has length 1 but for rounding."""
    return abs(math.fsum(x * x for x in vector) - 1.0) < 1e-14
