"""How fast the simulation is, for those who ask for it.

Publishes:
    ~performance_metrics (gazebo_msgs/PerformanceMetrics): while subscribed, every `PERIOD` of wall
        time; only if the parameter ~enable_performance_metrics is true. Gazebo has this topic from
        11.2 on. Sensors have no place of their own in the step here, so none are listed.
"""

import time

import rospy
from gazebo_msgs.msg import PerformanceMetrics

from ..messages import stamp
from ..server import Server

PERIOD = 0.2  # [s, wall]


class Pace:
    """Simulated time per wall time between two looks."""

    def __init__(self, simulated: float, wall: float) -> None:
        self._simulated, self._wall = simulated, wall

    def look(self, simulated: float, wall: float) -> float:
        """Return the real-time factor since the last look; both times in seconds."""
        gained = max(0.0, simulated - self._simulated)  # time jumps back at a reset
        passed = wall - self._wall
        self._simulated, self._wall = simulated, wall
        return gained / passed if passed > 0.0 else 0.0


def advertise_performance(server: Server) -> None:
    """Offer the topic, if the parameter asks for it."""
    if not rospy.get_param('~enable_performance_metrics', False):
        return
    publisher = rospy.Publisher('~performance_metrics', PerformanceMetrics, queue_size=10)
    clock = server.world.clock
    pace = Pace(clock.now, time.monotonic())

    def publish() -> None:
        message = PerformanceMetrics(real_time_factor=pace.look(clock.now, time.monotonic()))
        message.header.stamp = stamp(clock.now_ns)
        if publisher.get_num_connections() > 0:
            publisher.publish(message)

    server.loop.every(PERIOD, publish)
