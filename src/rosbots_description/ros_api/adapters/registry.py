"""The table of adapters, and the listener that gives every plugin of the world its adapter."""

import logging
import time
import warnings
from collections.abc import Callable, Iterable

import rospy
from rospy.impl.registration import get_topic_manager

from ...sim.errors import PluginError
from ...sim.model import Model
from ...sim.plugins.base import ModelPlugin
from ..names import is_for_all
from ..server import Server

logger = logging.getLogger(__name__)

# rospy prints so on standard error; we log it, where everything else about a model stands.
warnings.filterwarnings('ignore', '.* is not a legal ROS graph resource name', UserWarning)

# Least time between topics that come and topics that go, or go and come [s, wall]. A rospy
# subscriber that is still connecting when a topic goes misses the next publisher for good.
SETTLING = 0.15

_ADAPTERS: dict[type, type['Adapter']] = {}


class Adapter:
    """The topics of one plugin; making one raises `PluginError` if a topic cannot have its name.

    `open` and `close` talk to the ROS master, on the registrar's thread; `connect` and
    `disconnect` join the plugin's ports, on the thread that owns the world.
    """

    def __init__(self, server: Server, plugin: ModelPlugin) -> None:
        self.server = server
        self.plugin = plugin
        self._opened: list[rospy.Publisher | rospy.Subscriber] = []

    def open(self) -> None:
        """Advertise and subscribe."""

    def connect(self) -> None:
        """Join the plugin's outputs to the publishers."""

    def disconnect(self) -> None:
        """Let the plugin's outputs go nowhere."""

    def close(self) -> None:
        """Unregister what `open` registered."""
        for topic in self._opened:
            topic.unregister()

    def advertise(
        self, topic: str, message_class: type, queue_size: int
    ) -> rospy.Publisher | None:
        """Publish on a topic from now on; None, with an error, if this node sends others there."""
        return self._open_topic(
            topic, message_class, get_topic_manager().get_publications(),
            lambda: rospy.Publisher(topic, message_class, queue_size=queue_size))

    def subscribe(
        self, topic: str, message_class: type, take: Callable, queue_size: int
    ) -> rospy.Subscriber | None:
        """Take messages from now on; None, with an error, if this node takes others there."""
        return self._open_topic(
            topic, message_class, get_topic_manager().get_subscriptions(),
            lambda: rospy.Subscriber(topic, message_class, take, queue_size=queue_size))

    def _open_topic(
        self, topic: str, message_class: type, entries: Iterable[tuple[str, str]],
        make: Callable[[], rospy.Publisher | rospy.Subscriber],
    ) -> rospy.Publisher | rospy.Subscriber | None:
        """Return what `make` gives, unless `entries` has the topic with another type.

        rospy would mix the two.
        """
        if not is_for_all(topic):
            logger.warning('%s: the topic %s is only for nodes in Python: - or a dot is in it',
                           _where(self.plugin), topic)
        there = dict(entries).get(rospy.resolve_name(topic), message_class._type)
        if there != message_class._type:
            logger.error(
                "%s: the topic %s is left out as %s: this node has it as %s; give it another name",
                _where(self.plugin), topic, message_class._type, there,
            )
            return None
        self._opened.append(make())
        return self._opened[-1]


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


def _where(plugin: ModelPlugin) -> str:
    return f"model '{plugin.model.name}', plugin '{plugin.spec.name}'"


class Adapters:
    """Opens and closes adapters as models come and go."""

    def __init__(self, server: Server) -> None:
        self._server = server
        self._open: dict[ModelPlugin, Adapter] = {}
        self._last_change = ('', 0.0)  # what it was, and when [s, monotonic]

    def model_spawned(self, model: Model) -> None:
        """Give each plugin its topics; they appear shortly after."""
        for plugin in model.plugins:
            try:
                made = adapter_class(type(plugin))(self._server, plugin)
            except PluginError as error:
                logger.error('%s: %s; the model lives on without its topics', _where(plugin), error)
                continue
            self._open[plugin] = made
            self._server.registrar.post(lambda made=made: self._change('come', made.open))
            self._server.registrar.post(lambda made=made: self._connect(made))

    def model_deleted(self, model: Model) -> None:
        """Take the topics of each plugin away."""
        for plugin in model.plugins:
            gone = self._open.pop(plugin, None)
            if gone is None:
                continue
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
