"""Values of ~pub_clock_frequency."""

import math

import pytest

from rosbots_description.ros_api.topics.clock import clock_frequency


@pytest.mark.parametrize(('value', 'frequency'), [(0, 0), (100, 100), (100.0, 100), ('50', 50)])
def test_frequency_of_the_clock_is_an_integer(value, frequency, caplog):
    assert clock_frequency(value) == frequency
    assert not caplog.text


@pytest.mark.parametrize('value', ['abc', 0.5, math.nan, math.inf, [1], None])
def test_invalid_frequency_of_the_clock_is_reported_and_ignored(value, caplog):
    assert clock_frequency(value) == 0
    assert f'~pub_clock_frequency is {value!r}; it must be a whole number [Hz]' in caplog.text
