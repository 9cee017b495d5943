"""The topic /clock, published before anything that happens at its time.

Publishes:
    /clock (rosgraph_msgs/Clock): simulated time, every step or at ~pub_clock_frequency [Hz].
"""

import contextlib
import logging
import struct
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
_MESSAGE = struct.Struct('<3I')  # its size, seconds and nanoseconds
_MANY = 20  # numpy takes as long as Python for so many; at real time there are few at once


class ClockTopic(Topic, PreRunPublisher):
    """/clock at every step or, with a frequency, at the first step after each period."""

    def __init__(self, server: Server, frequency: int) -> None:
        super().__init__(server, '/clock', Clock)
        self._period_ns = NANOSECONDS // frequency if frequency > 0 else 0
        self._last_ns = 0

    def publish_ahead(self, last: int) -> None:
        """Publish the times of all due steps up to `last`."""
        clock = self._world.clock
        times: range | list[int] = range(
            clock.ns_at(self.due), clock.ns_at(last) + 1, clock.step_ns
        )
        if self._period_ns:
            times = list(self._due_times(last))
        publish_serialized(self._publisher, serialize_clock(times))
        self._last_ns = times[-1]
        self.due = self._next_due()

    def _due_times(self, last: int) -> Iterator[int]:
        """Yield the times of the due steps up to `last`, one for each period [ns]."""
        while self.due <= last:
            self._last_ns = self._world.clock.ns_at(self.due)
            self.due = self._next_due()
            yield self._last_ns

    def schedule(self) -> None:
        """Publish after the period, if there are subscribers."""
        super().schedule()
        clock = self._world.clock
        # After a jump back, publish at once: upstream would wait for the old time.
        self._last_ns = self._last_ns if self._last_ns <= clock.now_ns else 0
        if self.due != NEVER:
            self.due = max(clock.steps + 1, self._next_due())

    def _next_due(self) -> int:
        """Return the first step that is a period, or at all, later than the last published."""
        later = max(0, self._period_ns - 1)
        return self._world.clock.first_step_after(self._last_ns + later)


def serialize_clock(times: range | list[int]) -> bytes:
    """Return messages with these times [ns], each with its length prefix."""
    if len(times) < _MANY:
        pack, unit = _MESSAGE.pack, NANOSECONDS
        return b''.join([pack(_CLOCK_SIZE, *divmod(time, unit)) for time in times])
    messages = np.empty((len(times), 3), '<u4')
    messages[:, 0] = _CLOCK_SIZE
    if isinstance(times, range):
        numbers = np.arange(times.start, times.stop, times.step)
    else:
        numbers = np.array(times)
    messages[:, 1] = seconds = numbers // NANOSECONDS
    messages[:, 2] = numbers - seconds * NANOSECONDS
    return messages.tobytes()


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
