"""Messages give the readings that they were made of."""

import pytest
from gazebo_msgs.msg import ContactsState, ContactState
from geometry_msgs.msg import Quaternion, Vector3, Wrench, WrenchStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, JointState, LaserScan, Range
from std_msgs.msg import String

from rosbots_description.batch import value_at
from rosbots_description.ros_api.messages import read_reading


def odometry():
    message = Odometry()
    message.pose.pose.position.x, message.pose.pose.orientation.w = 1.5, 1.0
    message.twist.twist.angular.z = 0.25
    return message


@pytest.mark.parametrize(
    ('message', 'path', 'value'),
    [
        (odometry(), 'pose.position.x', 1.5),
        (odometry(), 'twist.angular.z', 0.25),
        (odometry(), 'pose.orientation.yaw', 0.0),
        (LaserScan(ranges=[2.0, 0.5, 1.0], range_max=9.0), 'ranges.min', 0.5),
        (LaserScan(ranges=[2.0, 0.5, 1.0], range_max=9.0), 'range_max', 9.0),
        (Range(range=0.75, radiation_type=Range.INFRARED), 'range', 0.75),
        (Range(radiation_type=Range.INFRARED), 'is_infrared', 1.0),
        (
            Imu(orientation=Quaternion(w=1.0), linear_acceleration=Vector3(0, 0, 9.8)),
            'linear_acceleration.z',
            9.8,
        ),
        (JointState(name=['a', 'b'], position=[1.0, 2.0]), 'positions.1', 2.0),
        (WrenchStamped(wrench=Wrench(force=Vector3(1, 2, 3))), 'force.y', 2.0),
        (ContactsState(states=[ContactState(), ContactState()]), 'count', 2.0),
    ],
)
def test_a_message_gives_the_value_of_its_reading(message, path, value):
    assert value_at(read_reading(message), path) == value


def test_a_type_that_holds_no_reading_is_named():
    with pytest.raises(ValueError, match='messages of the type std_msgs/String are not recorded'):
        read_reading(String())
