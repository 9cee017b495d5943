"""What joins one plugin to ROS, by the declarations of its class."""

import logging
import re
from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING

import rospy
from genpy import Message

from ...sim.plugins import ModelPlugin
from ..server import Server
from ..transport import (
    ReaderWatch,
    find_tf_prefix,
    frame_name,
    is_for_all,
    published_types,
    stop_publishing,
    subscribed_types,
)

if TYPE_CHECKING:
    from .declarations import Declaration

logger = logging.getLogger(__name__)

_TAG = re.compile('<([^<>]+)>')


class Adapter:
    """Opens and closes what is declared; making one raises `PluginError` if a name is none for ROS.

    `open` and `close` talk to the ROS master, on the registrar's thread; `connect`, `refresh` and
    `disconnect` are called on the thread that owns the world.
    """

    def __init__(
        self, server: Server, plugin: ModelPlugin, declared: 'Iterable[Declaration]' = ()
    ) -> None:
        self.server = server
        self.plugin = plugin
        self._connected = False
        self._watch = ReaderWatch(lambda: server.loop.post(self.refresh))
        self._opened: list[Callable[[], None]] = []  # what closes it
        self.endpoints = [one.join(self) for one in declared]

    def open(self) -> None:
        """Advertise, subscribe, and offer services."""
        for endpoint in self.endpoints:
            endpoint.open()

    def connect(self) -> None:
        """Join the plugin's outputs to the topics that were opened, from now on."""
        self._connected = True
        self.refresh()

    def refresh(self) -> None:
        """Join those outputs to their topics that have readers there, and no others."""
        if self._connected:
            for endpoint in self.endpoints:
                endpoint.refresh()

    def disconnect(self) -> None:
        """Let the plugin's outputs go nowhere."""
        self._connected = False
        for endpoint in self.endpoints:
            endpoint.disconnect()

    def close(self) -> None:
        """Unregister what was registered."""
        for close in self._opened:
            close()

    def text(self, template: str) -> str:
        """Return `template` with `<tag>` replaced by what the plugin has read as that tag."""
        return _TAG.sub(lambda tag: str(self.plugin.params.values[tag[1]]), template)

    @cached_property
    def tf_prefix(self) -> str:
        """Return the parameter tf_prefix; asks the ROS master for it once."""
        return find_tf_prefix(self.plugin.namespace)

    def frame(self, name: str) -> str:
        """Return a frame as messages name it."""
        return frame_name(self.tf_prefix, name)

    def advertise(
        self, topic: str, message_class: type[Message], queue_size: int, latch: bool = False
    ) -> rospy.Publisher | None:
        """Publish on a topic from now on; None, with an error, if this node sends others there."""
        if not self._is_free(topic, message_class, published_types()):
            return None
        watch = self._watch
        publisher = rospy.Publisher(
            topic, message_class, subscriber_listener=watch, queue_size=queue_size, latch=latch)
        self.on_close(lambda: stop_publishing(publisher, watch))
        return publisher

    def subscribe(
        self, topic: str, message_class: type[Message], take: Callable, queue_size: int
    ) -> rospy.Subscriber | None:
        """Take messages from now on; None, with an error, if this node takes others there."""
        if not self._is_free(topic, message_class, subscribed_types()):
            return None
        subscriber = rospy.Subscriber(topic, message_class, take, queue_size=queue_size)
        self.on_close(subscriber.unregister)
        return subscriber

    def on_close(self, close: Callable[[], None]) -> None:
        """Call `close()` when the plugin goes."""
        self._opened.append(close)

    def _is_free(
        self, topic: str, message_class: type[Message], types: Mapping[str, str]
    ) -> bool:
        """Tell whether `types` has the topic with no other type; rospy would mix the two."""
        if not is_for_all(topic):
            logger.warning('%s: the topic %s is only for nodes in Python: - or a dot is in it',
                           where(self.plugin), topic)
        there = types.get(rospy.resolve_name(topic), message_class._type)
        if there != message_class._type:
            logger.error(
                "%s: the topic %s is left out as %s: this node has it as %s; give it another name",
                where(self.plugin), topic, message_class._type, there,
            )
        return there == message_class._type


def where(plugin: ModelPlugin) -> str:
    """Name a plugin in a message."""
    return f"model '{plugin.model.name}', plugin '{plugin.spec.name}'"
