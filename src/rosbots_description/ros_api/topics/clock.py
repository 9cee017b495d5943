"""The topic /clock, published before anything that happens at its time.

Publishes:
    /clock (rosgraph_msgs/Clock): simulated time, every step or at ~pub_clock_frequency [Hz].
"""

import contextlib
import logging
from collections.abc import Iterator

import numpy as np
import rospy
from rosgraph_msgs.msg import Clock

from ...sim.core import NANOSECONDS
from ...sim.runtime import NEVER, PreRunPublisher
from ..server import Server
from ..transport import publish_serialized
from .topic import Topic

logger = logging.getLogger(__name__)

_CLOCK_SIZE = 8  # [bytes] of a serialized message: seconds and nanoseconds


class ClockTopic(Topic, PreRunPublisher):
    """/clock at every step or, with a frequency, at the first step after each period."""

    def __init__(self, server: Server, frequency: int) -> None:
        super().__init__(server, '/clock', Clock)
        self._period_ns = NANOSECONDS // frequency if frequency > 0 else 0
        self._last_ns = 0

    def publish_ahead(self, last: int) -> None:
        """Publish the times of all due steps up to `last`."""
        clock, due = self._world.clock, np.arange(self.due, last + 1)
        if self._period_ns:
            due = np.fromiter(self._due_until(last), np.int64)
        # vectorised: a loop takes 1 us for each
        times = clock.ns_at(0) + due * clock.step_ns
        messages = np.empty((len(times), 3), '<u4')
        messages[:, 0] = _CLOCK_SIZE
        messages[:, 1] = secs = times // NANOSECONDS
        messages[:, 2] = times - secs * NANOSECONDS
        publish_serialized(self._publisher, messages.tobytes())
        self._last_ns = int(times[-1])
        self.due = self._first_after(int(due[-1]))

    def _due_until(self, last: int) -> Iterator[int]:
        """Yield the due steps up to `last`, one for each period."""
        step = self.due
        while step <= last:
            yield step
            self._last_ns = self._world.clock.ns_at(step)
            step = self._first_after(step)

    def schedule(self) -> None:
        """Publish after the period, if there are subscribers."""
        super().schedule()
        clock = self._world.clock
        # After a jump back, publish at once: upstream would wait for the old time.
        self._last_ns = self._last_ns if self._last_ns <= clock.now_ns else 0
        if self.due != NEVER:
            self.due = self._first_after(clock.steps)

    def _first_after(self, step: int) -> int:
        """Return the first step after `step` that is a period after the last published one."""
        clock = self._world.clock
        if not self._period_ns:
            return step + 1
        return max(step + 1, clock.first_step_after(self._last_ns + self._period_ns - 1))


def advertise_clock(server: Server) -> None:
    """Publish /clock before anything that happens at its time."""
    topic = ClockTopic(server, clock_frequency(rospy.get_param('~pub_clock_frequency', 0)))
    server.world.schedule.add_pre_run_publisher(topic)
    server.world.listeners.append(topic)
    topic.schedule()


def clock_frequency(value: object) -> int:
    """Return the parameter's value [Hz]; for other than whole numbers log an error, return 0."""
    with contextlib.suppress(ValueError, OverflowError):
        if isinstance(value, int | float | str) and int(value) == float(value):
            return int(value)
    logger.error('~pub_clock_frequency is %r; it must be a whole number [Hz]. 0 is used', value)
    return 0
