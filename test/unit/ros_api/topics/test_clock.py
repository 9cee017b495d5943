"""What ~pub_clock_frequency may say."""

import math

import pytest

from rosbots_description.ros_api.topics.clock import clock_frequency


@pytest.mark.parametrize(('value', 'frequency'), [(0, 0), (100, 100), (100.0, 100), ('50', 50)])
def test_the_clocks_frequency_is_a_whole_number(value, frequency, caplog):
    assert clock_frequency(value) == frequency
    assert not caplog.text


@pytest.mark.parametrize('value', ['abc', 0.5, math.nan, math.inf, [1], None])
def test_another_frequency_of_the_clock_is_named_and_not_used(value, caplog):
    assert clock_frequency(value) == 0
    assert f'~pub_clock_frequency is {value!r}; it must be a whole number [Hz]' in caplog.text
