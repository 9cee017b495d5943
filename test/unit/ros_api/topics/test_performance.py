"""Rates of sensors, as performance metrics tell them."""

from types import SimpleNamespace

from rosbots_description.ros_api.topics.performance import SensorRates


class FakeSensor(SimpleNamespace):
    __hash__ = object.__hash__


def test_rates_are_those_since_the_last_look():
    read = FakeSensor(scoped_name='bot::link::laser', count=7, last_ns=1_000_000_000)
    idle = FakeSensor(scoped_name='bot::link::camera', count=0, last_ns=0)
    paces = SensorRates()
    assert [one.sim_update_rate for one in paces.update([read, idle], 0.0)] == [0.0, 0.0]
    read.count, read.last_ns = 15, 1_200_000_000
    laser, camera = paces.update([read, idle], 0.4)
    assert (laser.name, laser.sim_update_rate, laser.real_update_rate, laser.fps) == (
        'bot::link::laser', 40.0, 20.0, -1.0)
    assert (camera.name, camera.sim_update_rate, camera.real_update_rate) == (
        'bot::link::camera', 0.0, 0.0)


def test_after_a_reset_of_time_no_rate_is_negative():
    sensor = FakeSensor(scoped_name='s', count=7, last_ns=1_000_000_000)
    paces = SensorRates()
    paces.update([sensor], 0.2)
    sensor.count, sensor.last_ns = 9, 50_000_000
    assert paces.update([sensor], 0.2)[0].sim_update_rate == 0.0
