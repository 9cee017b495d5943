"""Commands whose first subscriber is still on its way."""

import threading
from collections import deque
from collections.abc import Callable
from typing import Any

import genpy
import rospy

LATEST = 2  # commands that wait: for a robot that drives, one, and the stop after it


class Commands(rospy.SubscribeListener):  # type: ignore[misc]  # rospy has no types
    """The commands to one topic; the first wait until a subscriber has connected."""

    def __init__(self, topic: str, kind: type[Any]) -> None:
        super().__init__()
        self._lock = threading.Lock()
        self._waiting: deque[genpy.Message] = deque(maxlen=LATEST)
        self._publisher = rospy.Publisher(topic, kind, self, queue_size=LATEST)

    def publish(self, command: genpy.Message) -> None:
        """Publish a command, or keep it for the subscriber that connects first."""
        with self._lock:
            self._waiting.append(command)
            if self._publisher.get_num_connections():
                self._pass_on(self._publisher.publish)

    def peer_subscribe(
        self, _topic: str, _publish: Callable[[Any], None], peer_publish: Callable[[Any], None]
    ) -> None:
        """Publish what has waited; rospy calls it when a subscriber has connected."""
        with self._lock:
            self._pass_on(peer_publish)

    def _pass_on(self, publish: Callable[[Any], None]) -> None:
        while self._waiting:
            publish(self._waiting.popleft())
