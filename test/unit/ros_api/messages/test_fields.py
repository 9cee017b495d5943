"""Numbers within messages, by rqt_plot's paths."""

import math

import pytest
from gazebo_msgs.msg import ModelStates
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Bool, Float64, String

from rosbots_description.ros_api.messages import number_getter, number_paths
from rosbots_description.sim.core import SimError


def test_all_numbers_of_a_message_have_a_path():
    assert number_paths(Float64) == ('data',)
    assert number_paths(String) == ()
    assert number_paths(JointState) == ('position[0]', 'velocity[0]', 'effort[0]')
    odometry = number_paths(Odometry)
    assert {'pose/pose/position/x', 'twist/twist/angular/z', 'pose/covariance[0]'} <= set(odometry)
    assert not [path for path in odometry if path.startswith('header')]
    assert 'twist[0]/linear/x' in number_paths(ModelStates)


@pytest.mark.parametrize('kind', [Odometry, ModelStates, JointState, Image])
def test_each_path_can_be_read(kind):
    for path in number_paths(kind):
        number_getter(kind, path)(kind())


def test_a_number_is_read():
    message = ModelStates(twist=[Twist(), Twist(linear=Vector3(x=0.5))])
    assert number_getter(ModelStates, 'twist[1]/linear/x')(message) == 0.5
    assert number_getter(Image, 'data[1]')(Image(data=b'\x01\x02')) == 2.0
    assert number_getter(Bool, 'data')(Bool(True)) == 1.0


def test_an_element_that_is_not_there_is_nan():
    assert math.isnan(number_getter(ModelStates, 'twist[7]/linear/x')(ModelStates()))


@pytest.mark.parametrize(
    ('kind', 'path', 'sentence'),
    [
        (
            Odometry,
            'twist/foo',
            "TwistWithCovariance has no field 'foo'; it has twist, covariance.",
        ),
        (Odometry, 'twist/twist', "'twist/twist' is not a number but a geometry_msgs/Twist."),
        (JointState, 'position', "'position' of sensor_msgs/JointState is an array; add an index"),
        (JointState, 'position[]', "no field 'position\\[\\]'"),
        (JointState, 'position[-1]', "no field 'position\\[-1\\]'"),
        (JointState, 'name[0]', "'name\\[0\\]' is not a number but a string."),
        (Float64, 'data[0]', "'data' of std_msgs/Float64 is no array; leave out \\[0\\]."),
        (Float64, 'data/x', "float64 has no field 'x'."),
        (Float64, '', "std_msgs/Float64 has no field ''"),
        (Float64, '__class__', "std_msgs/Float64 has no field '__class__'"),
    ],
)
def test_what_is_no_number_is_told(kind, path, sentence):
    with pytest.raises(SimError, match=sentence):
        number_getter(kind, path)
