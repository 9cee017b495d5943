"""Plain values to messages and back; nothing else happens here.

Both sides order quaternions (x, y, z, w). The `fill_` functions write into a message that is
there already, which is what makes publishing at 1000 Hz cheap.
"""

import math

from genpy import Time
from geometry_msgs.msg import Point, Transform, Vector3
from geometry_msgs.msg import Pose as PoseMessage
from geometry_msgs.msg import Quaternion as QuaternionMessage
from geometry_msgs.msg import Twist as TwistMessage

from ...sim.core import Pose, Quaternion, Twist, Vector, normalise


def stamp(now_ns: int) -> Time:
    """Return a simulated time [ns] as message time."""
    return Time(*divmod(now_ns, 1_000_000_000))


def fill_pose(message: PoseMessage, pose: Pose) -> None:
    """Write `pose` into `message`."""
    position, orientation = message.position, message.orientation
    position.x, position.y, position.z = pose.position
    orientation.x, orientation.y, orientation.z, orientation.w = pose.orientation


def fill_transform(message: Transform, pose: Pose) -> None:
    """Write `pose` into `message`."""
    position, orientation = message.translation, message.rotation
    position.x, position.y, position.z = pose.position
    orientation.x, orientation.y, orientation.z, orientation.w = pose.orientation


def fill_twist(message: TwistMessage, twist: Twist) -> None:
    """Write `twist` into `message`."""
    linear, angular = message.linear, message.angular
    linear.x, linear.y, linear.z = twist.linear
    angular.x, angular.y, angular.z = twist.angular


def read_pose(message: PoseMessage) -> Pose:
    """Return a message's pose with its quaternion normalised; all zeros mean no rotation.

    Raises:
        ValueError: a number is NaN or infinite.

    """
    pose = Pose(read_vector(message.position), read_quaternion(message.orientation))
    if not all(math.isfinite(number) for part in pose for number in part):
        raise ValueError('the pose holds a number that is not finite')
    return Pose(pose.position, normalise(pose.orientation))


def read_transform(message: Transform) -> Pose:
    """Return a message's transform as `read_pose` returns a pose, and with its errors."""
    t = message.translation
    return read_pose(PoseMessage(Point(t.x, t.y, t.z), message.rotation))


def read_vector(message: Point | Vector3) -> Vector:
    """Return a message's three numbers."""
    return (message.x, message.y, message.z)


def read_quaternion(message: QuaternionMessage) -> Quaternion:
    """Return a message's four numbers, as they are."""
    return (message.x, message.y, message.z, message.w)


def read_twist(message: TwistMessage) -> Twist:
    """Return a message's velocities."""
    return Twist(read_vector(message.linear), read_vector(message.angular))
