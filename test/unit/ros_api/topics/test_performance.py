"""Rates of sensors in the performance metrics."""

from types import SimpleNamespace

import pytest

from rosbots_description.ros_api.topics.performance import SensorRates
from rosbots_description.sim.runtime.scheduler import NEVER


class FakeSensor(SimpleNamespace):
    __hash__ = object.__hash__

    def __init__(self, kind='ray', due=1, count=0, last_ns=0):
        super().__init__(
            spec=SimpleNamespace(type=kind),
            scoped_name=f'bot::link::{kind}',
            due=due,
            count=count,
            last_ns=last_ns,
        )

    def give(self, count, milliseconds):
        self.count, self.last_ns = self.count + count, milliseconds * 1_000_000


def rates(metrics):
    return [(one.sim_update_rate, one.real_update_rate, one.fps) for one in metrics]


def test_rates_are_those_since_the_last_update():
    laser, camera = FakeSensor('ray', count=7, last_ns=1_000_000_000), FakeSensor('camera')
    sensor_rates = SensorRates()
    metrics = sensor_rates.update('w', [laser, camera], 3.0)
    assert rates(metrics) == [(0.0, 0.0, -1.0), (0.0, 0.0, 0.0)]
    laser.give(8, 1200)
    camera.give(1, 1100)
    metrics = sensor_rates.update('w', [laser, camera], 3.4)
    assert [one.name for one in metrics] == ['w::bot::link::ray', 'w::bot::link::camera']
    assert rates(metrics)[0] == pytest.approx((40.0, 20.0, -1.0))
    camera.give(6, 1300)
    assert rates(sensor_rates.update('w', [camera], 3.9)) == [pytest.approx((30.0, 12.0, 12.0))]


def test_slow_sensor_keeps_its_rate_between_readings_while_subscribed():
    sensor, sensor_rates = FakeSensor(), SensorRates()
    for second in range(3):
        sensor.give(1, 1000 * second)
        metrics = [sensor_rates.update('w', [sensor], second + 0.2 * part) for part in range(5)]
    assert set(map(tuple, map(rates, metrics))) == {((1.0, 1.0, -1.0),)}
    sensor.due = NEVER
    assert rates(sensor_rates.update('w', [sensor], 3.2)) == [(0.0, 0.0, -1.0)]


def test_time_without_readers_is_not_a_period():
    sensor, sensor_rates = FakeSensor(due=NEVER, count=5, last_ns=1_000_000_000), SensorRates()
    sensor_rates.update('w', [sensor], 0.0)
    sensor.due = 1
    sensor.give(1, 9000)
    assert rates(sensor_rates.update('w', [sensor], 0.2)) == [(0.0, 0.0, -1.0)]
    sensor.give(4, 9100)
    assert rates(sensor_rates.update('w', [sensor], 0.4)) == [pytest.approx((40.0, 20.0, -1.0))]


def test_no_rate_is_negative_after_a_reset_of_time():
    sensor, sensor_rates = FakeSensor(count=7, last_ns=1_000_000_000), SensorRates()
    sensor_rates.update('w', [sensor], 0.0)
    sensor.give(2, 50)
    assert rates(sensor_rates.update('w', [sensor], 0.2)) == [(0.0, 0.0, -1.0)]
    sensor.give(2, 100)
    assert rates(sensor_rates.update('w', [sensor], 0.4))[0][0] == pytest.approx(40.0)
