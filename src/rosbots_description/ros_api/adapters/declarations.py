"""Declarations of a plugin's topics and services.

Names are relative to the plugin's namespace; `<tag>` in a name is replaced by the value of the tag.
"""

import logging
import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from operator import attrgetter
from typing import Any

import rospy
from genpy import Message

from ..messages import stamp
from ..transport import has_subscribers, next_number, publish_serialized, topic_name
from .adapter import Adapter, owner_name

logger = logging.getLogger(__name__)

COMPLAINT_PERIOD = 5.0  # minimum time between two errors about invalid commands [s, wall]

# Number of the header, time [ns] and reading -> the message as it goes over the wire.
Serializer = Callable[[int, int, Any], bytes]


class Endpoint:
    """One topic or service of a plugin; `Adapter` says who calls what on which thread."""

    name = ''  # global; '' for one that has another kind of name

    def __init__(self, adapter: Adapter, name: str | None = None) -> None:
        self.adapter = adapter
        if name is not None:
            self.text = adapter.text(name)
            self.name = topic_name(adapter.plugin.namespace, self.text)

    def open(self) -> None:
        """Register it."""

    def refresh(self) -> None:
        """Connect the plugin's output while there are subscribers."""

    def disconnect(self) -> None:
        """Disconnect the plugin's output."""

    def log(self, text: str) -> None:
        """Log upstream's message at debug level; {} is replaced by the name as written."""
        if text:
            logger.debug('%s%s', self.adapter.plugin.log_prefix, text.format(self.text))


# One topic or service of all plugins of a class: makes the endpoint of an adapter's plugin.
Declaration = Callable[[Adapter], Endpoint]


class PublishedTopic(Endpoint):
    """A topic that publishes the readings of an output, if the plugin has it."""

    _serialize: Serializer | None = None

    def __init__(self, adapter: Adapter, declared: 'Publishes') -> None:
        super().__init__(adapter, declared.topic or adapter.plugin.topic_names[declared.output])
        self.declared = declared
        self.publisher: rospy.Publisher | None = None
        self._output = adapter.plugin.outputs.get(declared.output)
        self._connected = False

    def open(self) -> None:
        """Advertise it."""
        declared, adapter = self.declared, self.adapter
        if not (self.has_output or declared.always):
            return
        if declared.frame is not None:
            self._frame = adapter.frame(adapter.text(declared.frame))
        if declared.serializer is not None:
            self._serialize = declared.serializer(adapter)
        self._clock = adapter.server.world.clock
        self.publisher = adapter.advertise(
            self.name, declared.message, declared.queue, declared.latch
        )
        self.log(declared.log)

    @property
    def has_output(self) -> bool:
        """Whether the description requests the output."""
        return self._output is not None

    def is_wanted(self) -> bool:
        """Return whether the topic has subscribers."""
        return has_subscribers(self.publisher)

    def refresh(self) -> None:
        """Connect the output while there are subscribers."""
        output = self._output
        if output is None:
            return
        wanted = self.is_wanted()
        if wanted and not self._connected:
            output.connect(self.send)
        elif self._connected and not wanted:
            output.disconnect(self.send)
        self._connected = wanted

    def disconnect(self) -> None:
        """Disconnect the output."""
        if self._output is not None and self._connected:
            self._output.disconnect(self.send)
        self._connected = False

    def send(self, reading: object) -> None:
        """Publish a reading."""
        publisher: rospy.Publisher = self.publisher
        now_ns = self._clock.now_ns
        if self._serialize is not None:
            publish_serialized(publisher, self._serialize(next_number(publisher), now_ns, reading))
            return
        message = self.declared.convert(reading)
        if self.declared.frame is not None:
            message.header.stamp, message.header.frame_id = stamp(now_ns), self._frame
        publisher.publish(message)


@dataclass(frozen=True)
class Publishes:
    """Publish the readings of an output on a topic, while it has subscribers."""

    output: str
    message: type[Message]
    topic: str | None = None  # None: the one that the plugin's `topic_names` has for the output
    convert: Callable[[Any], Message] = lambda reading: reading  # reading -> message
    frame: str | None = None  # if given, fill in the header; a name that may contain <tag>
    queue: int = 1
    latch: bool = False
    serializer: Callable[[Adapter], Serializer] | None = (
        None  # replaces `convert` where speed matters
    )
    always: bool = False  # advertise even if the description does not request the output
    log: str = ''  # debug message after advertising
    endpoint: type[PublishedTopic] = PublishedTopic  # the class of the topic

    def __call__(self, adapter: Adapter) -> PublishedTopic:
        """Return the topic of the adapter's plugin."""
        return self.endpoint(adapter, self)


@dataclass(frozen=True)
class Subscribes:
    """Call a method of the plugin for each message of a topic, between two steps."""

    call: str  # the method
    message: type[Message]
    # Returns the method's arguments; raises ValueError for an invalid message.
    read: Callable[[Message], tuple[Any, ...]]
    topic: str | None = None  # None: the one that the plugin's `topic_names` has for the method
    queue: int = 1
    log_before: str = ''  # debug message before subscribing
    log: str = ''  # debug message after subscribing

    def __call__(self, adapter: Adapter) -> 'SubscribedTopic':
        """Return the topic of the adapter's plugin."""
        return SubscribedTopic(adapter, self)


class SubscribedTopic(Endpoint):
    """A topic that commands a plugin; invalid messages are dropped and change nothing."""

    def __init__(self, adapter: Adapter, declared: Subscribes) -> None:
        super().__init__(adapter, declared.topic or adapter.plugin.topic_names[declared.call])
        self._declared = declared
        self._last_complaint = -math.inf

    def open(self) -> None:
        """Subscribe to it."""
        declared = self._declared
        self.log(declared.log_before)
        self.adapter.subscribe(self.name, declared.message, self._receive, declared.queue)
        self.log(declared.log)

    def _receive(self, message: Message) -> None:
        plugin, declared = self.adapter.plugin, self._declared
        try:
            arguments = declared.read(message)
        except ValueError as error:
            if time.monotonic() > self._last_complaint + COMPLAINT_PERIOD:
                self._last_complaint = time.monotonic()
                logger.error(
                    '%sdropped a command on %s with %s', plugin.log_prefix, self.text, error
                )
        else:
            self.adapter.server.loop.post(lambda: self._command(*arguments))

    def _command(self, *arguments: object) -> None:
        """Call the method; an invalid command changes nothing."""
        plugin = self.adapter.plugin
        try:
            getattr(plugin, self._declared.call)(*arguments)
        except ValueError as error:
            logger.error('%s%s: %s', plugin.log_prefix, self.text, error)


def finite(*fields: str) -> Callable[[Message], tuple[float, ...]]:
    """Return a function that reads finite numbers from a message, such as 'linear.x'."""
    getters = [attrgetter(field) for field in fields]

    def read(message: Message) -> tuple[float, ...]:
        numbers = tuple(get(message) for get in getters)
        bad = [
            f'{field} {number}'
            for field, number in zip(fields, numbers, strict=True)
            if not math.isfinite(number)
        ]
        if bad:
            raise ValueError(f'{" and ".join(bad)}; numbers must be finite')
        return numbers

    return read


@dataclass(frozen=True)
class Offers:
    """Another ROS interface with the lifetime of the plugin, such as a service."""

    name: str
    # Opens it, and returns a function to close it; raises rospy.ServiceException if a service of
    # its name exists.
    make: Callable[[Adapter, str], Callable[[], None]]

    def __call__(self, adapter: Adapter) -> 'Offered':
        """Return the endpoint of the adapter's plugin."""
        return Offered(adapter, self)


class Offered(Endpoint):
    """An interface that was declared by `Offers`."""

    def __init__(self, adapter: Adapter, declared: Offers) -> None:
        super().__init__(adapter, declared.name)
        self._declared = declared

    def open(self) -> None:
        """Offer it, unless another plugin offers a service of its name."""
        try:
            close = self._declared.make(self.adapter, self.name)
        except rospy.ServiceException:
            logger.warning(
                '%s: the services of %s are those of another plugin; names of its own, or a '
                'robot_namespace, would give this one its own',
                owner_name(self.adapter.plugin),
                self.name,
            )
        else:
            self.adapter.on_close(close)
