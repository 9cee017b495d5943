"""Which topics a plugin has, and the listener that opens and closes them with its model."""

import time
from collections.abc import Callable
from functools import partial

from ...sim.plugins import ModelPlugin
from ...sim.runtime import Model
from ..server import Server
from .adapter import Adapter
from .declarations import Declaration

# Minimum time between opening and closing topics, and vice versa [s, wall]. A rospy subscriber that
# is still connecting when a topic is closed never connects to the next publisher.
SETTLING = 0.15

_TOPICS: dict[type[ModelPlugin], tuple[Declaration, ...]] = {}


def connects(plugin_class: type[ModelPlugin], *declared: Declaration) -> None:
    """Give the plugins of a class these topics, which are opened in this order."""
    if plugin_class in _TOPICS:
        raise ValueError(f'{plugin_class.__name__} has its topics already')
    _TOPICS[plugin_class] = declared


def topics_of(plugin_class: type[ModelPlugin]) -> tuple[Declaration, ...]:
    """Return the topics of the plugins of a class.

    Raises:
        KeyError: nobody has declared any.
    """
    return _TOPICS[plugin_class]


class Adapters:
    """Opens and closes adapters as models come and go."""

    def __init__(self, server: Server) -> None:
        self._server = server
        self._open: dict[ModelPlugin, Adapter] = {}
        self._last_change = ('', 0.0)  # what it was, and when [s, monotonic]
        server.static_frames.listeners.append(self._refresh)

    def model_spawned(self, model: Model) -> None:
        """Give each plugin its topics; they appear shortly after."""
        for plugin in _with_topics(model):
            made = self._open[plugin] = Adapter(self._server, plugin, topics_of(type(plugin)))
            self._server.registrar.post(partial(self._change, 'come', made.open))
            self._server.registrar.post(partial(self._connect, made))

    def model_deleted(self, model: Model) -> None:
        """Take the topics of each plugin away."""
        for plugin in _with_topics(model):
            gone = self._open.pop(plugin)
            gone.disconnect()
            self._server.registrar.post(partial(self._change, 'go', gone.close))

    def world_reset(self) -> None:
        """Topics outlive a reset."""

    def _refresh(self) -> None:
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
        """Connect on the world's thread, unless the model has gone meanwhile."""

        def connect() -> None:
            if self._open.get(made.plugin) is made:
                made.connect()

        self._server.loop.post(connect)


def _with_topics(model: Model) -> list[ModelPlugin]:
    """Return the plugins of a model that may have topics."""
    return [plugin for plugin in model.plugins if isinstance(plugin, ModelPlugin)]
