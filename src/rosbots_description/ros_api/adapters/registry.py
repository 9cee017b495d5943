"""The table of adapters, and the listener that gives every plugin of the world its adapter."""

import logging
import time
from collections.abc import Callable

from ...sim.model import Model
from ...sim.plugins.base import ModelPlugin
from ..server import Server

logger = logging.getLogger(__name__)

# Least time between topics that come and topics that go, or go and come [s, wall]. A rospy
# subscriber that is still connecting when a topic goes misses the next publisher for good.
SETTLING = 0.15

_ADAPTERS: dict[type, type['Adapter']] = {}


class Adapter:
    """The topics of one plugin.

    `open` and `close` talk to the ROS master, on the registrar's thread; `connect` and
    `disconnect` join the plugin's ports, on the thread that owns the world.
    """

    def __init__(self, server: Server, plugin: ModelPlugin) -> None:
        self.server = server
        self.plugin = plugin

    def open(self) -> None:
        """Advertise and subscribe."""

    def connect(self) -> None:
        """Join the plugin's outputs to the publishers."""

    def disconnect(self) -> None:
        """Let the plugin's outputs go nowhere."""

    def close(self) -> None:
        """Unregister what `open` registered."""


def adapter(plugin_class: type) -> Callable[[type[Adapter]], type[Adapter]]:
    """Return a class decorator that makes an adapter serve the plugins of a class."""

    def add(cls: type[Adapter]) -> type[Adapter]:
        if plugin_class in _ADAPTERS:
            raise ValueError(f'{plugin_class.__name__} has the adapter {_ADAPTERS[plugin_class]}')
        _ADAPTERS[plugin_class] = cls
        return cls

    return add


def adapter_class(plugin_class: type) -> type[Adapter]:
    """Return the adapter for a plugin class.

    Raises:
        KeyError: nobody wrote one.

    """
    return _ADAPTERS[plugin_class]


class Adapters:
    """Opens and closes adapters as models come and go."""

    def __init__(self, server: Server) -> None:
        self._server = server
        self._open: dict[ModelPlugin, Adapter] = {}
        self._last_change = ('', 0.0)  # what it was, and when [s, monotonic]

    def model_spawned(self, model: Model) -> None:
        """Give each plugin its topics; they appear shortly after."""
        for plugin in model.plugins:
            made = adapter_class(type(plugin))(self._server, plugin)
            self._open[plugin] = made
            self._server.registrar.post(lambda made=made: self._change('come', made.open))
            self._server.registrar.post(lambda made=made: self._connect(made))

    def model_deleted(self, model: Model) -> None:
        """Take the topics of each plugin away."""
        for plugin in model.plugins:
            gone = self._open.pop(plugin)
            gone.disconnect()
            self._server.registrar.post(lambda gone=gone: self._change('go', gone.close))

    def world_reset(self) -> None:
        """Topics outlive a reset."""

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
