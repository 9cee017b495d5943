"""Connect one plugin to ROS, by the declarations of its class."""

import logging
from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import rospy
from genpy import Message

from ...sim.core import SimError
from ...sim.plugins import ModelPlugin
from ..server import Server
from ..transport import (
    SubscriberWatch,
    find_tf_prefix,
    frame_name,
    is_valid_name,
    published_types,
    stop_publishing,
    subscribed_types,
)

if TYPE_CHECKING:
    from ...sim.controllers import Controller
    from .declarations import Declaration, Endpoint

HasTopics: TypeAlias = 'ModelPlugin | Controller'

logger = logging.getLogger(__name__)


class Adapter:
    """Opens and closes the declared topics and services of a plugin or controller.

    Those whose names are not valid ROS names are left out, with an error.

    `open` and `close` talk to the ROS master, on the registrar's thread; `connect`, `refresh` and
    `disconnect` are called on the thread that owns the world.
    """

    def __init__(
        self, server: Server, plugin: HasTopics, declared: 'Iterable[Declaration]' = ()
    ) -> None:
        self.server = server
        self.plugin = plugin
        self._connected = False
        self.is_closed = False
        self._watch = SubscriberWatch(lambda: server.loop.post(self.refresh))
        self._opened: list[Callable[[], None]] = []  # functions to call in `close`
        self.endpoints = self._with_valid_names([declaration(self) for declaration in declared])

    def _with_valid_names(self, endpoints: 'list[Endpoint]') -> 'list[Endpoint]':
        invalid = {one.name for one in endpoints if one.name and not is_valid_name(one.name)}
        if invalid:
            logger.error(
                '%s: not opened, since ROS has no such names: %s; use a-z, A-Z, 0-9 and _, '
                "separated by slashes, in the tags that they are made of, and in the model's name",
                owner_name(self.plugin),
                ', '.join(map(repr, sorted(invalid))),
            )
        return [one for one in endpoints if one.name not in invalid]

    def open(self) -> None:
        """Advertise, subscribe, and offer services."""
        for endpoint in self.endpoints:
            endpoint.open()

    def connect(self) -> None:
        """Connect the plugin's outputs to the opened topics."""
        self._connected = True
        self.refresh()

    def refresh(self) -> None:
        """Connect the outputs whose topics have subscribers, and disconnect the others."""
        if self._connected:
            for endpoint in self.endpoints:
                endpoint.refresh()

    def disconnect(self) -> None:
        """Disconnect the plugin's outputs."""
        self._connected = False
        for endpoint in self.endpoints:
            endpoint.disconnect()

    def close(self) -> None:
        """Unregister what was registered."""
        self.is_closed = True
        for close in self._opened:
            close()

    def call(self, command: Callable[[], object]) -> None:
        """Carry out a command of a service between two steps.

        Raises:
            rospy.ServiceException: it was refused, or the simulator is shutting down.
        """
        try:
            self.server.loop.call(command)
        except SimError as error:
            raise rospy.ServiceException(str(error)) from None

    def text(self, template: str) -> str:
        """Return `template` with `<tag>` replaced by the plugin's value of that tag."""
        return self.plugin.params.fill(template)

    @cached_property
    def tf_prefix(self) -> str:
        """The parameter tf_prefix, read from the ROS master once."""
        return find_tf_prefix(self.plugin.namespace)

    def frame(self, name: str) -> str:
        """Return a frame name with the prefix, as used in messages."""
        return frame_name(self.tf_prefix, name)

    def advertise(
        self, topic: str, message_class: type[Message], queue_size: int, latch: bool = False
    ) -> rospy.Publisher | None:
        """Advertise a topic; None, with an error, if this node publishes another type on it."""
        if not self._is_free(topic, message_class, published_types()):
            return None
        watch = self._watch
        publisher = rospy.Publisher(
            topic, message_class, subscriber_listener=watch, queue_size=queue_size, latch=latch
        )
        self.on_close(lambda: stop_publishing(publisher, watch))
        return publisher

    def subscribe(
        self, topic: str, message_class: type[Message], take: Callable[[Any], None], queue_size: int
    ) -> rospy.Subscriber | None:
        """Subscribe to a topic; None, with an error, if this node subscribes to another type."""
        if not self._is_free(topic, message_class, subscribed_types()):
            return None
        subscriber = rospy.Subscriber(topic, message_class, take, queue_size=queue_size)
        self.on_close(subscriber.unregister)
        return subscriber

    def on_close(self, close: Callable[[], None]) -> None:
        """Call `close()` when the plugin is unloaded."""
        self._opened.append(close)

    def _is_free(self, topic: str, message_class: type[Message], types: Mapping[str, str]) -> bool:
        """Return whether `types` has no other type for the topic; rospy would mix the two."""
        there = types.get(rospy.resolve_name(topic), message_class._type)
        if there != message_class._type:
            logger.error(
                '%s: the topic %s is not opened as %s: this node uses it as %s; rename it',
                owner_name(self.plugin),
                topic,
                message_class._type,
                there,
            )
        return bool(there == message_class._type)


def owner_name(plugin: HasTopics) -> str:
    """Return the name of a plugin or controller for messages."""
    return f"model '{plugin.model.name}', plugin '{plugin.spec.name}'"
