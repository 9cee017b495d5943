"""The topics that other nodes publish or subscribe to, asked of the ROS master."""

import time
from typing import Any

import rospy

from ..transport import NO_MASTER

LIFETIME = 0.3  # [s, wall] of an answer, so that panels that look at once share it


class TopicGraph:
    """What the ROS master knows of topics."""

    def __init__(self) -> None:
        self._asked = 0.0  # [s, monotonic]
        self._types: dict[str, str] = {}
        self._state: tuple[Any, ...] = ([], [])

    def published(self) -> dict[str, str]:
        """Return the types of the topics that other nodes publish, by name; {} without a master."""
        return self._others(0)

    def subscribed(self) -> dict[str, str]:
        """Return the types of the topics that other nodes subscribe to; {} without a master."""
        return self._others(1)

    def _others(self, part: int) -> dict[str, str]:
        if time.monotonic() - self._asked > LIFETIME:
            self._ask()
        types, own = self._types, rospy.get_name()
        return {
            name: types[name]
            for name, nodes in sorted(self._state[part])
            if name in types and set(nodes) - {own}
        }

    def _ask(self) -> None:
        master = rospy.get_master()
        try:
            self._types = dict(master.getTopicTypes()[2])
            self._state = tuple(master.getSystemState()[2])
        except NO_MASTER:
            self._types = {}
        self._asked = time.monotonic()
