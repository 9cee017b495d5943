"""The sensors of robots, while they are looked at.

Subscribes:
    the topics of `open`, until they are closed.
"""

from collections.abc import Collection

from ...sim.core import Pose, SimError
from ...sim.description import ShownReading
from ..messages import SENSOR_TYPES, shown_reading
from .feed import Feed
from .frames import FrameFinder
from .topic_graph import TopicGraph


class RosSensors:
    """Sensors by their topics."""

    def __init__(self, topics: TopicGraph) -> None:
        self._topics = topics
        self._feeds: dict[str, Feed] = {}
        self._frames = FrameFinder()

    def sensor_topics(self) -> dict[str, str]:
        """Return the types of the topics of sensors that other nodes publish, by name."""
        return {name: kind for name, kind in self._topics.published().items()
                if kind in SENSOR_TYPES}

    def open(self, topic: str, kind: str) -> None:
        """Subscribe to a topic of one of these types."""
        self._feeds[topic] = Feed(topic, SENSOR_TYPES[kind])

    def close(self, topic: str) -> None:
        """Unsubscribe."""
        self._feeds.pop(topic).close()
        if not self._feeds:
            self._frames.forget()

    def read(self, topic: str) -> ShownReading | None:
        """Return the newest reading of an open topic; None if there is none since the last call.

        Raises:
            SimError: it cannot be shown.
        """
        taken = self._feeds[topic].take()
        try:
            return shown_reading(taken[-1][1]) if taken else None
        except SimError as error:
            raise SimError(f'A message of {topic} is not shown: {error}.') from error

    def locate(self, frame: str, links: Collection[str]) -> tuple[str, Pose] | None:
        """Return the link of these that a frame is fixed to, with its pose there; None if unknown.

        It listens to TF until it has found all that it was asked for.
        """
        return self._frames.locate(frame, links)
