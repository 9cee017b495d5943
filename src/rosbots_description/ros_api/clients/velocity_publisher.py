"""Publishes velocity commands, optionally repeated."""

from __future__ import annotations

import threading
import time

import rospy
from geometry_msgs.msg import Twist, TwistStamped

_BREATH = 0.05  # [s] wall time to send a message: the queue holds only one


class VelocityPublisher:
    """Sends each command at once and, with a rate, repeats the last one while no new one comes.

    Publishes:
        cmd_vel (geometry_msgs/Twist, or TwistStamped when stamped), not latched
    """

    def __init__(self, stamped: bool = False, frame_id: str = '', repeat_rate: float = 0.0) -> None:
        """Advertise the topic; the node must have been started.

        Args:
            frame_id: frame of stamped commands.
            repeat_rate: [Hz, wall]; 0 means no repetition. Repetition starts at once, with
                zeros, so that the robot gets commands from the beginning.
        """
        self._stamped = stamped
        self._frame_id = frame_id
        self._twist = Twist()
        self._sent = 0  # number of commands, to detect that no repetition is needed
        self._ended = False
        self._changed = threading.Condition()
        self._publisher = rospy.Publisher(
            'cmd_vel', TwistStamped if stamped else Twist, queue_size=1
        )
        rospy.on_shutdown(self.end)
        if repeat_rate > 0.0:
            threading.Thread(target=self._repeat, args=(1.0 / repeat_rate,), daemon=True).start()

    @property
    def topic(self) -> str:
        """Name of the topic after remapping."""
        return str(self._publisher.name)

    def has_subscribers(self) -> bool:
        """Tell whether the topic has subscribers."""
        return bool(self._publisher.get_num_connections())

    def send(self, linear: tuple[float, float, float], angular: float) -> None:
        """Publish a command: linear [m/s] along x, y, z and angular [rad/s] about z."""
        with self._changed:
            if self._ended:
                return
            self._twist = Twist()
            self._twist.linear.x, self._twist.linear.y, self._twist.linear.z = linear
            self._twist.angular.z = angular
            self._sent += 1
            self._publish()
            self._changed.notify()

    def end(self) -> None:
        """Stop the robot, with two messages as the original, and send nothing more.

        rospy calls this on shutdown, too, while publishing is still possible.
        """
        for _ in range(0 if self._ended else 2):
            self.send((0.0, 0.0, 0.0), 0.0)
            time.sleep(_BREATH)
        with self._changed:
            self._ended = True
            self._changed.notify()

    def _publish(self) -> None:
        message = self._twist
        if self._stamped:
            message = TwistStamped(twist=self._twist)
            message.header.stamp = rospy.Time.now()
            message.header.frame_id = self._frame_id
        self._publisher.publish(message)

    def _repeat(self, period: float) -> None:
        """Publish the last command again after each period [s, wall] without a new one."""
        with self._changed:
            while not self._ended and not rospy.is_shutdown():
                sent = self._sent
                self._changed.wait(period)
                if self._sent == sent and not self._ended:
                    self._publish()
