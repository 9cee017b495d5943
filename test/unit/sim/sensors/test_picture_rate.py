"""Whether pictures keep up with their rate is judged once."""

import pytest

from rosbots_description.sim.sensors.camera import PictureRate

PERIOD = 40_000_000  # [ns], 25 Hz


def reports(taken, count=1000, start=0):
    """Return what is reported of pictures that are due one after the other."""
    rate = PictureRate()
    found = [rate.count(start + k * PERIOD, taken(k)) for k in range(count)]
    return [report for report in found if report is not None]


def test_the_rates_are_reported_once():
    ((taken, due),) = reports(lambda k: k % 2 == 0)
    assert taken == pytest.approx(12.5, abs=0.2)
    assert due == pytest.approx(25.0)


@pytest.mark.parametrize('skipped', [0, 50])  # none, or one in 50
def test_nothing_is_reported_while_pictures_keep_up(skipped):
    assert reports(lambda k: not skipped or k % skipped != 0) == []


@pytest.mark.parametrize(('period', 'first'), [(PERIOD, 125), (10**9, 9)])
def test_the_rate_is_judged_after_five_seconds_and_ten_pictures(period, first):
    rate = PictureRate()
    found = [rate.count(7 + k * period, False) for k in range(first + 1)]
    assert found == [None] * first + [(0.0, pytest.approx(1e9 / period))]


@pytest.mark.parametrize(('missing', 'reported'), [(6, 0), (7, 1)])  # of 126
@pytest.mark.parametrize('windows', [0, 3])
def test_a_twentieth_of_the_pictures_may_be_left_out(missing, reported, windows):
    assert len(reports(lambda k: not 0 <= k - 126 * windows < missing)) == reported


def test_a_slow_time_after_a_fast_one_is_reported():
    assert len(reports(lambda k: k < 500 or k % 3 == 0)) == 1


def test_a_reset_of_time_begins_anew():
    rate = PictureRate()
    for k in range(100):
        assert rate.count(10**12 + k * PERIOD, False) is None
    assert rate.count(0, True) is None
    assert [report for k in range(1, 200) if (report := rate.count(k * PERIOD, True))] == []
