"""Plain values to messages and back; nothing else happens here.

Both sides order quaternions (x, y, z, w). The `fill_` functions write into a message that is
there already, which is what makes publishing at 1000 Hz cheap.
"""

import math

from genpy import Time
from geometry_msgs.msg import Point, Transform, TransformStamped, Vector3
from geometry_msgs.msg import Pose as PoseMessage
from geometry_msgs.msg import Twist as TwistMessage
from nav_msgs.msg import Odometry as OdometryMessage
from sensor_msgs.msg import JointState

from ..sim.pose import Pose, Twist, Vector, normalise
from ..sim.readings import JointStates, Odometry


def stamp(now_ns: int) -> Time:
    """Return a simulated time [ns] as message time."""
    return Time(*divmod(now_ns, 1_000_000_000))


def fill_pose(message: PoseMessage, pose: Pose) -> None:
    """Write `pose` into `message`."""
    position, orientation = message.position, message.orientation
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
    p, q = message.position, message.orientation
    pose = Pose((p.x, p.y, p.z), (q.x, q.y, q.z, q.w))
    if not all(math.isfinite(number) for part in pose for number in part):
        raise ValueError('the pose holds a number that is not finite')
    return Pose(pose.position, normalise(pose.orientation))


def read_vector(message: Point | Vector3) -> Vector:
    """Return a message's three numbers."""
    return (message.x, message.y, message.z)


def read_twist(message: TwistMessage) -> Twist:
    """Return a message's velocities."""
    return Twist(read_vector(message.linear), read_vector(message.angular))


def fill_odometry(message: OdometryMessage, now_ns: int, odometry: Odometry) -> None:
    """Write a reading into a message whose frames and covariances are set."""
    message.header.stamp = stamp(now_ns)
    fill_pose(message.pose.pose, odometry.pose)
    fill_twist(message.twist.twist, odometry.twist)


def transform_message(parent: str, child: str) -> TransformStamped:
    """Return a message for the edge between two frames, to be filled."""
    message = TransformStamped(child_frame_id=child, transform=Transform())
    message.header.frame_id = parent
    return message


def fill_transform(message: TransformStamped, now_ns: int, pose: Pose) -> None:
    """Write where the child stands in its parent."""
    message.header.stamp = stamp(now_ns)
    translation, rotation = message.transform.translation, message.transform.rotation
    translation.x, translation.y, translation.z = pose.position
    rotation.x, rotation.y, rotation.z, rotation.w = pose.orientation


def joint_state_message(now_ns: int, reading: JointStates) -> JointState:
    """Return names and positions; velocity and effort stay empty, as Gazebo's plugin has it."""
    message = JointState(name=list(reading.names), position=list(reading.positions))
    message.header.stamp = stamp(now_ns)
    return message
