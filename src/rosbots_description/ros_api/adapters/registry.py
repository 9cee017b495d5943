"""Which topics a plugin has, and the listener that opens and closes them with its model."""

import time
from collections.abc import Callable
from functools import partial
from typing import Any

from ...sim.plugins import ModelPlugin
from ...sim.runtime import Listener, Model
from ..server import Server
from .adapter import Adapter, HasTopics
from .declarations import Declaration

# Minimum time between opening and closing topics, and vice versa [s, wall]. A rospy subscriber that
# is still connecting when a topic is closed never connects to the next publisher.
SETTLING = 0.15

_TOPICS: dict[type[Any], tuple[Declaration, ...]] = {}


def declare_topics(owner: type[Any], *declared: Declaration) -> None:
    """Give the plugins or controllers of a class these topics, which are opened in this order.

    A subclass has them, too, unless it is given its own.
    """
    if owner in _TOPICS:
        raise ValueError(f'{owner.__name__} has its topics already')
    _TOPICS[owner] = declared


def topics_of(owner: type[Any]) -> tuple[Declaration, ...]:
    """Return the topics of the plugins or controllers of a class.

    Raises:
        KeyError: nobody has declared any.
    """
    for cls in owner.__mro__:
        if cls in _TOPICS:
            return _TOPICS[cls]
    raise KeyError(owner.__name__)


class AdapterSet:
    """Opens and closes the topics of plugins or controllers; called on the world's thread."""

    def __init__(self, server: Server) -> None:
        self._server = server
        self._open: dict[HasTopics, Adapter] = {}
        self._last_change = ('', 0.0)  # what it was, and when [s, monotonic]

    def add(self, owner: HasTopics) -> None:
        """Give it its topics; they appear shortly after."""
        made = self._open[owner] = Adapter(self._server, owner, topics_of(type(owner)))
        self._server.registrar.post(partial(self._change, 'come', made.open))
        self._server.registrar.post(partial(self._connect, made))

    def remove(self, owner: HasTopics) -> None:
        """Take its topics away."""
        gone = self._open.pop(owner)
        gone.disconnect()
        self._server.registrar.post(partial(self._change, 'go', gone.close))

    def set_to(self, owners: list[HasTopics]) -> None:
        """Add and remove, so that these and no others have topics."""
        for owner in [owner for owner in self._open if owner not in owners]:
            self.remove(owner)
        for owner in owners:
            if owner not in self._open:
                self.add(owner)

    def refresh(self) -> None:
        """Connect what has subscribers, and disconnect the rest."""
        for adapter in self._open.values():
            adapter.refresh()

    def _change(self, kind: str, job: Callable[[], None]) -> None:
        """Open or close topics, once the listeners have followed the opposite change."""
        before, when = self._last_change
        if kind != before:
            time.sleep(max(0.0, when + SETTLING - time.monotonic()))
        try:
            job()
        finally:
            self._last_change = (kind, time.monotonic())

    def _connect(self, made: Adapter) -> None:
        """Connect on the world's thread, unless its owner was removed meanwhile."""

        def connect() -> None:
            if self._open.get(made.plugin) is made:
                made.connect()

        self._server.loop.post(connect)


class Adapters(Listener):
    """Opens and closes the topics of plugins as models come and go."""

    def __init__(self, server: Server) -> None:
        self._adapters = AdapterSet(server)
        server.static_frames.listeners.append(self._adapters.refresh)

    def model_spawned(self, model: Model) -> None:
        """Give each plugin its topics."""
        for plugin in _with_topics(model):
            self._adapters.add(plugin)

    def model_deleted(self, model: Model) -> None:
        """Take the topics of each plugin away."""
        for plugin in _with_topics(model):
            self._adapters.remove(plugin)

    def world_reset(self) -> None:
        """Topics outlive a reset; those with a rate begin a new period."""
        self._adapters.refresh()


def _with_topics(model: Model) -> list[ModelPlugin]:
    """Return the plugins of a model that may have topics."""
    return [plugin for plugin in model.plugins.values() if isinstance(plugin, ModelPlugin)]
