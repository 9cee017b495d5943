"""Records: numbers of readings by name, and their statistics."""

import math

import numpy as np
import pytest

from rosbots_description.batch import JointReading, Statistics, check_vectors, value_at
from rosbots_description.sim import Odometry, Pose, Twist, from_rpy
from rosbots_description.sim.sensors import Scan

ODOMETRY = Odometry(Pose((1.0, 2.0, 3.0), from_rpy(0.1, 0.2, 0.3)), Twist((4.0, 5.0, 6.0)))
SCAN = Scan(np.array([2.0, math.inf, 1.0]), np.zeros(3), -1.0, 1.0, 1.0, 0.1, 10.0)


@pytest.mark.parametrize(
    ('reading', 'path', 'value'),
    [
        (ODOMETRY, 'pose.position.y', 2.0),
        (ODOMETRY, 'pose.orientation.yaw', 0.3),
        (ODOMETRY, 'pose.orientation.roll', 0.1),
        (ODOMETRY, 'twist.linear.z', 6.0),
        (ODOMETRY, 'pose.position.0', 1.0),
        (ODOMETRY, 'pose.position.max', 3.0),
        (SCAN, 'ranges.min', 1.0),
        (SCAN, 'ranges.0', 2.0),
        (SCAN, 'ranges.count', 3.0),
        (SCAN, 'range_max', 10.0),
        (JointReading(0.5, 2.0), 'velocity', 2.0),
        ((), 'count', 0.0),
    ],
)
def test_a_number_is_found_by_its_name(reading, path, value):
    assert value_at(reading, path) == pytest.approx(value)


@pytest.mark.parametrize(
    ('reading', 'path', 'said'),
    [
        (ODOMETRY, 'pose.x', "there is no 'x' in it, but position, orientation"),
        (ODOMETRY, 'pose', 'is not a number; it has position, orientation'),
        (ODOMETRY, 'pose.position.yaw', "no 'yaw' in it, but x, y, z"),
        (ODOMETRY, 'twist.linear.x.y', "no 'y' in it, but only a number"),
        (SCAN, 'ranges.3', "no '3' in it"),
        (ODOMETRY, '__class__', "no '__class__'"),
    ],
)
def test_what_is_not_there_is_named_with_what_is(reading, path, said):
    with pytest.raises(ValueError, match=said):
        value_at(reading, path)


def test_statistics_of_a_series():
    made = Statistics()
    for value in (2.0, -1.0, 5.0):
        made.add(value)
    assert made.columns('x') == {'x_end': 5.0, 'x_min': -1.0, 'x_max': 5.0, 'x_mean': 2.0}


def test_nothing_recorded_is_none():
    assert set(Statistics().columns('x').values()) == {None}


def test_fields_that_are_left_out_are_zero():
    assert check_vectors({'linear': {'x': 1}}, ('linear', 'angular')) == [(1.0, 0, 0), (0, 0, 0)]


@pytest.mark.parametrize(
    ('message', 'said'),
    [
        ({'linear': {'x': math.nan}}, 'linear.x is nan; numbers must be finite'),
        ({'linear': {'x': 'fast'}}, 'linear.x is fast'),
        ({'linear': {'q': 1.0}}, 'linear has x, y and z'),
        ({'speed': {'x': 1.0}}, 'the message has the fields linear and angular'),
        (0.5, 'the message has the fields'),
    ],
)
def test_an_invalid_message_is_named(message, said):
    with pytest.raises(ValueError, match=said):
        check_vectors(message, ('linear', 'angular'))
