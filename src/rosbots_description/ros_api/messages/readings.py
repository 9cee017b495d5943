"""Messages to the readings that they were made of; the inverse of what the adapters do."""

from collections.abc import Callable
from typing import Any

import numpy as np
from genpy import Message

from ...sim.runtime import JointStates, Odometry
from ...sim.sensors import Distance, ImuReading, JointWrench, Scan
from .conversions import read_pose, read_quaternion, read_twist, read_vector


def _scan(message: Message) -> Scan:
    return Scan(
        np.array(message.ranges, float),
        np.array(message.intensities, float),
        message.angle_min,
        message.angle_max,
        message.angle_increment,
        message.range_min,
        message.range_max,
    )


def _imu(message: Message) -> ImuReading:
    return ImuReading(
        read_quaternion(message.orientation),
        read_vector(message.angular_velocity),
        read_vector(message.linear_acceleration),
    )


_READERS: dict[str, Callable[[Any], object]] = {
    'gazebo_msgs/ContactsState': lambda message: tuple(message.states),
    'geometry_msgs/WrenchStamped': lambda message: JointWrench(
        read_vector(message.wrench.force), read_vector(message.wrench.torque)
    ),
    'nav_msgs/Odometry': lambda message: Odometry(
        read_pose(message.pose.pose), read_twist(message.twist.twist)
    ),
    'sensor_msgs/Imu': _imu,
    'sensor_msgs/JointState': lambda message: JointStates(
        tuple(message.name), tuple(message.position), tuple(message.velocity), tuple(message.effort)
    ),
    'sensor_msgs/LaserScan': _scan,
    'sensor_msgs/Range': lambda message: Distance(
        message.range,
        message.min_range,
        message.max_range,
        message.field_of_view,
        message.radiation_type == message.INFRARED,
    ),
}


def read_reading(message: Message) -> object:
    """Return the reading of a message.

    Raises:
        ValueError: messages of its type hold no reading that is known here.
    """
    read = _READERS.get(message._type)
    if read is None:
        raise ValueError(
            f'messages of the type {message._type} are not recorded; those that are: '
            f'{", ".join(_READERS)}'
        )
    return read(message)
