"""The messages of a topic, kept until they are taken."""

import threading
import time
from collections import deque
from typing import Any

import genpy
import rospy

BUFFER = 1 << 22  # [bytes] read at once, so that of large messages the newest is at hand


class Feed:
    """Subscribes to a topic, from its making until it is closed; a slow taker gets the newest."""

    def __init__(self, topic: str, kind: type[Any], kept: int = 1, period: float = 0.0) -> None:
        """Subscribe.

        Args:
            kind: the class of its messages.
            kept: how many messages wait at most.
            period: of those that come within so long [s, wall], the last one is kept; 0: all.
        """
        self._period = period
        self._lock = threading.Lock()
        self._waiting: deque[tuple[float, Any]] = deque(maxlen=kept)
        self._subscriber = rospy.Subscriber(
            topic, kind, self._keep, queue_size=kept, buff_size=BUFFER
        )

    def take(self) -> list[tuple[float, Any]]:
        """Return what came since the last call: times of arrival [s, monotonic], and messages."""
        with self._lock:
            taken = list(self._waiting)
            self._waiting.clear()
        return taken

    def close(self) -> None:
        """Unsubscribe."""
        self._subscriber.unregister()

    def _keep(self, message: genpy.Message) -> None:
        now = time.monotonic()
        with self._lock:
            if (
                self._waiting
                and self._period
                and (now // self._period == self._waiting[-1][0] // self._period)
            ):
                self._waiting.pop()
            self._waiting.append((now, message))
