"""Curves over the last seconds."""

import math

import numpy as np
import pytest

from rosbots_description.web.panels.chart import HOLD, STEP, WINDOW, Chart


@pytest.fixture
def chart():
    chart = Chart()
    chart.add('a')
    return chart


def at(chart, now, time):
    """Return the values of all curves at a time, as they are shown at another."""
    times, *curves = chart.table(now)
    column = int(np.abs(times - time).argmin())
    assert times[column] == pytest.approx(time)
    return [curve[column] for curve in curves]


def test_the_table_is_the_last_seconds(chart):
    times, values = chart.table(100.02)
    assert (times[0], times[-1]) == (pytest.approx(100.0 - WINDOW + STEP), pytest.approx(100.0))
    assert np.diff(times) == pytest.approx(STEP)
    assert np.isnan(values).all()


def test_the_table_begins_with_the_simulation(chart):
    assert chart.table(1.0)[0][0] == 0.0
    assert chart.table(0.0)[0].tolist() == [0.0]


def test_each_time_has_the_newest_value_until_then(chart):
    chart.add('b')
    for time, value in ((10.0, 1.0), (10.1, 2.0), (10.12, 3.0)):
        chart.note('a', time, value)
    chart.note('b', 10.1, 7.0)
    assert at(chart, 11.0, 10.0)[0] == 1.0
    assert at(chart, 11.0, 10.05)[0] == 1.0
    assert at(chart, 11.0, 10.1) == [2.0, 7.0]
    assert at(chart, 11.0, 10.15) == [3.0, 7.0]
    assert math.isnan(at(chart, 11.0, 9.95)[0])


def test_a_topic_that_has_ended_is_not_drawn_on(chart):
    chart.note('a', 10.0, 1.0)
    assert at(chart, 20.0, 10.0 + HOLD) == [1.0]
    assert math.isnan(at(chart, 20.0, 10.0 + HOLD + STEP)[0])


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf])
def test_what_is_no_number_is_a_gap(chart, value):
    chart.note('a', 10.0, 1.0)
    chart.note('a', 10.1, value)
    assert math.isnan(at(chart, 11.0, 10.1)[0])


def test_a_reset_of_time_begins_the_curve_anew(chart):
    chart.note('a', 10.0, 1.0)
    chart.note('a', 0.5, 2.0)
    assert at(chart, 1.0, 0.5) == [2.0]
    assert at(chart, 11.0, 10.0 - STEP) != [1.0]
    chart.clear()
    assert np.isnan(chart.table(1.0)[1]).all()


def test_a_late_sample_leaves_the_curve_as_it_is(chart):
    for time, value in ((10.0, 1.0), (10.1, 2.0), (10.05, 3.0), (10.2, 4.0)):
        chart.note('a', time, value)
    assert [at(chart, 11.0, time) for time in (10.0, 10.05, 10.1, 10.2)] == [
        [1.0],
        [1.0],
        [3.0],
        [4.0],
    ]


def test_old_samples_are_not_kept(chart):
    for second in range(1000):
        chart.note('a', float(second), 0.0)
    assert len(chart._curves['a']) <= 2 * WINDOW + 1


def test_curves_come_and_go(chart):
    chart.add('b')
    chart.remove('a')
    assert chart.curves == ('b',)
    assert len(chart.table(1.0)) == 2
