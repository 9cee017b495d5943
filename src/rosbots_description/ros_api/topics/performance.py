"""The topic of performance metrics: real-time factor and sensor rates.

Publishes:
    ~performance_metrics (gazebo_msgs/PerformanceMetrics): while subscribed, every `PERIOD` of wall
        time; only if the parameter ~enable_performance_metrics is true. Gazebo has this topic from
        11.2 on. Sensors without readers are idle: their rate is 0.
"""

import time
from collections.abc import Iterable
from typing import NamedTuple

import rospy
from gazebo_msgs.msg import PerformanceMetrics, SensorPerformanceMetric

from ...sim.core import NANOSECONDS
from ...sim.runtime import NEVER, SensorPart
from ..messages import stamp
from ..server import Server

PERIOD = 0.2  # [s, wall]
_WITH_FPS = ('camera', 'depth')  # the fps of other types is -1, as in Gazebo


class RealTimeFactor:
    """Real-time factor between two samples."""

    def __init__(self, simulated: float, wall: float) -> None:
        self._simulated, self._wall = simulated, wall

    def update(self, simulated: float, wall: float) -> float:
        """Return the real-time factor since the last sample; both times in seconds."""
        gained = max(0.0, simulated - self._simulated)  # time jumps back at a reset
        passed = wall - self._wall
        self._simulated, self._wall = simulated, wall
        return gained / passed if passed > 0.0 else 0.0


class _Sample(NamedTuple):
    """What was known of a sensor at its last reading; `last_ns` is None while it has no readers."""

    readings: int = 0  # so far
    last_ns: int | None = None
    wall: float = 0.0  # [s]
    sim_rate: float = 0.0  # [Hz]
    real_rate: float = 0.0  # [Hz]


class SensorRates:
    """Update rates of sensors, between two samples with new readings."""

    def __init__(self) -> None:
        self._samples: dict[SensorPart, _Sample] = {}

    def update(
        self, world: str, sensors: Iterable[SensorPart], wall: float
    ) -> list[SensorPerformanceMetric]:
        """Return the rates of sensors.

        Args:
            world: its name, with which Gazebo's names of sensors begin.
            wall: the time [s].
        """
        before, self._samples = self._samples, {}
        found = []
        for sensor in sensors:
            sample = self._samples[sensor] = _sample(sensor, before.get(sensor, _Sample()), wall)
            found.append(
                SensorPerformanceMetric(
                    f'{world}::{sensor.scoped_name}',
                    sample.sim_rate,
                    sample.real_rate,
                    sample.real_rate if sensor.spec.type in _WITH_FPS else -1.0,
                )
            )
        return found


def _sample(sensor: SensorPart, before: _Sample, wall: float) -> _Sample:
    if sensor.due == NEVER:
        return _Sample(sensor.count)
    readings = sensor.count - before.readings
    if not readings:
        return before
    sim_rate, real_rate = before.sim_rate, before.real_rate
    if before.last_ns is not None and sensor.last_ns > before.last_ns:  # else time was reset
        sim_rate = readings * NANOSECONDS / (sensor.last_ns - before.last_ns)
        real_rate = readings / (wall - before.wall)
    return _Sample(sensor.count, sensor.last_ns, wall, sim_rate, real_rate)


def advertise_performance(server: Server) -> None:
    """Advertise the topic, if the parameter enables it."""
    if not rospy.get_param('~enable_performance_metrics', False):
        return
    publisher = rospy.Publisher('~performance_metrics', PerformanceMetrics, queue_size=10)
    clock = server.world.clock
    factor, rates = RealTimeFactor(clock.now, time.monotonic()), SensorRates()

    def publish() -> None:
        now = time.monotonic()
        message = PerformanceMetrics(real_time_factor=factor.update(clock.now, now))
        models = server.world.models.values()
        message.sensors = rates.update(
            server.world.name,
            (sensor for model in models for sensor in model.sensors.values()),
            now,
        )
        message.header.stamp = stamp(clock.now_ns)
        if publisher.get_num_connections() > 0:
            publisher.publish(message)

    server.loop.every(PERIOD, publish)
