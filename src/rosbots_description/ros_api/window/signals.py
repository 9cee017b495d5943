"""Numbers of any topic over time, while they are plotted.

Subscribes:
    the topics of `open`, until their last curve is closed.
"""

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import genpy
import roslib.message

from ...sim.core import SimError
from ..messages import number_getter, number_paths
from .feed import Feed
from .topic_graph import TopicGraph

KEPT, PERIOD = 500, 0.02  # messages of a topic that wait at most; one in each period [s, wall]


class RosSignals:
    """Curves by rqt_plot's names: topic and field, as `/odom/twist/twist/linear/x`."""

    def __init__(self, topics: TopicGraph) -> None:
        self._topics = topics
        self._feeds: dict[str, Feed] = {}
        self._curves: dict[str, tuple[str, Callable[[Any], float]]] = {}

    def signal_topics(self) -> dict[str, tuple[str, ...]]:
        """Return the paths of the numbers in each topic that other nodes publish."""
        topics = self._topics.published().items()
        return {name: paths for name, kind in topics if (paths := _paths(kind))}

    def open(self, curve: str) -> None:
        """Begin to read a curve.

        Raises:
            SimError: no such topic is published, or its messages have no such number.
        """
        topics = self._topics.published()
        topic = max((name for name in topics if curve.startswith(f'{name}/')), key=len, default='')
        if not topic:
            raise SimError(
                f"No topic of '{curve}' is published; a curve is one with a field, such as "
                '/odom/twist/twist/linear/x.'
            )
        kind = _class(topics[topic])
        if kind is None:
            raise SimError(f'This machine has no messages {topics[topic]}, those of {topic}.')
        self._curves[curve] = topic, number_getter(kind, curve.removeprefix(f'{topic}/'))
        if topic not in self._feeds:
            self._feeds[topic] = Feed(topic, kind, KEPT, PERIOD)

    def close(self, curve: str) -> None:
        """End that."""
        topic, _ = self._curves.pop(curve)
        if topic not in {other for other, _ in self._curves.values()}:
            self._feeds.pop(topic).close()

    def read(self) -> Mapping[str, list[tuple[float | None, float, float]]]:
        """Return what came for each open curve since the last call.

        That are the stamp of a message [s, simulated], None without; when it arrived
        [s, monotonic]; and the number.
        """
        taken = {topic: feed.take() for topic, feed in self._feeds.items()}
        return {
            curve: [(_stamp(message), arrival, get(message)) for arrival, message in taken[topic]]
            for curve, (topic, get) in self._curves.items()
        }


@cache
def _paths(kind: str) -> tuple[str, ...]:
    found = _class(kind)
    return number_paths(found) if found else ()


def _class(kind: str) -> type[Any] | None:
    try:
        found: type[Any] | None = roslib.message.get_message_class(kind)
    except ValueError:  # no name of a type: '*', of a topic that nobody knows
        return None
    return found


def _stamp(message: genpy.Message) -> float | None:
    return message.header.stamp.to_sec() or None if message._has_header else None
