"""Values of ~pub_clock_frequency, and messages of /clock."""

import io
import math

import genpy
import pytest
from rosgraph_msgs.msg import Clock
from rospy.msg import serialize_message

from rosbots_description.ros_api.topics.clock import clock_frequency, serialize_clock


@pytest.mark.parametrize(('value', 'frequency'), [(0, 0), (100, 100), (100.0, 100), ('50', 50)])
def test_frequency_of_the_clock_is_an_integer(value, frequency, caplog):
    assert clock_frequency(value) == frequency
    assert not caplog.text


@pytest.mark.parametrize('value', ['abc', 0.5, math.nan, math.inf, [1], None])
def test_invalid_frequency_of_the_clock_is_reported_and_ignored(value, caplog):
    assert clock_frequency(value) == 0
    assert f'~pub_clock_frequency is {value!r}; it must be a whole number [Hz]' in caplog.text


@pytest.mark.parametrize('count', [1, 5, 1000])
@pytest.mark.parametrize('kind', [range, list])
def test_messages_are_those_of_rospy(count, kind):
    times = range(7_999_000_000, 7_999_000_000 + count * 1_000_000, 1_000_000)
    expected = io.BytesIO()
    for time in times:
        serialize_message(expected, 0, Clock(genpy.Time(0, time)))
    made = serialize_clock(times if kind is range else list(times))
    assert made == expected.getvalue()
