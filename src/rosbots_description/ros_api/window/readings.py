"""Topics whose messages are shown, while they are looked at.

Subscribes:
    the topics of `open`, until they are closed.
"""

from collections.abc import Collection, Mapping
from typing import Any

from ...sim.core import Pose, SimError
from ...sim.description import ShownReading
from ..messages import shown_reading
from .feed import Feed
from .frames import FrameFinder
from .topic_graph import TopicGraph


class RosReadings:
    """Topics of some types, such as those of sensors."""

    def __init__(self, graph: TopicGraph, types: Mapping[str, type[Any]]) -> None:
        self._graph, self._types = graph, types
        self._feeds: dict[str, Feed] = {}
        self._frames = FrameFinder()

    def offered(self) -> dict[str, str]:
        """Return the types of the topics of these types that other nodes publish, by name."""
        return {name: kind for name, kind in self._graph.published().items() if kind in self._types}

    def open(self, topic: str, kind: str) -> None:
        """Subscribe to a topic of one of these types."""
        self._feeds[topic] = Feed(topic, self._types[kind])

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
        """Return a link of these that TF connects a frame with, and the frame's pose in it.

        None if none is connected. It listens to TF until it knows where all frames are fixed that
        it was asked for.
        """
        return self._frames.locate(frame, links)
