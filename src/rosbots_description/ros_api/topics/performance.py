"""The topic of performance metrics: real-time factor and sensor rates.

Publishes:
    ~performance_metrics (gazebo_msgs/PerformanceMetrics): while subscribed, every `PERIOD` of wall
        time; only if the parameter ~enable_performance_metrics is true. Gazebo has this topic from
        11.2 on. Sensors without readers are idle: their rate is 0.
"""

import time
from collections.abc import Iterable

import rospy
from gazebo_msgs.msg import PerformanceMetrics, SensorPerformanceMetric

from ...sim.core import NANOSECONDS
from ...sim.runtime import SensorLife
from ..messages import stamp
from ..server import Server

PERIOD = 0.2  # [s, wall]


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


class SensorRates:
    """Update rates of sensors between two samples."""

    def __init__(self) -> None:
        self._before: dict[SensorLife, tuple[int, int]] = {}  # count, time of the last reading [ns]

    def update(self, sensors: Iterable[SensorLife], passed: float) -> list[SensorPerformanceMetric]:
        """Return the rates of sensors since the last sample, `passed` [s, wall] ago."""
        now = {sensor: (sensor.count, sensor.last_ns) for sensor in sensors}
        before, self._before = self._before, now
        found = []
        for sensor, (count, last_ns) in now.items():
            old_count, old_ns = before.get(sensor, (count, last_ns))
            gained, span = count - old_count, (last_ns - old_ns) / NANOSECONDS
            found.append(SensorPerformanceMetric(
                sensor.scoped_name, gained / span if span > 0.0 else 0.0,
                gained / passed if passed > 0.0 else 0.0, -1.0))
        return found


def advertise_performance(server: Server) -> None:
    """Advertise the topic, if the parameter enables it."""
    if not rospy.get_param('~enable_performance_metrics', False):
        return
    publisher = rospy.Publisher('~performance_metrics', PerformanceMetrics, queue_size=10)
    clock = server.world.clock
    begin = time.monotonic()
    factor, rates = RealTimeFactor(clock.now, begin), SensorRates()

    def publish() -> None:
        nonlocal begin
        now = time.monotonic()
        message = PerformanceMetrics(real_time_factor=factor.update(clock.now, now))
        models = server.world.models.values()
        message.sensors = rates.update(
            (sensor for model in models for sensor in model.sensors), now - begin)
        begin = now
        message.header.stamp = stamp(clock.now_ns)
        if publisher.get_num_connections() > 0:
            publisher.publish(message)

    server.loop.every(PERIOD, publish)
