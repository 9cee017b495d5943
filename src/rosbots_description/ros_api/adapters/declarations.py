"""What can be declared of a plugin's topics and services.

Names stand in the plugin's namespace, and `<tag>` in one stands for what was read as that tag.
"""

import logging
import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from operator import attrgetter
from typing import Any, Protocol

import rospy
from genpy import Message

from ..messages import stamp
from ..transport import has_readers, next_number, publish_serialized, topic_name
from .adapter import Adapter

logger = logging.getLogger(__name__)

COMPLAINT_PERIOD = 5.0  # least time between two complaints about bad commands [s, wall]

# Number of the header, time [ns] and reading -> the message as it goes over the wire.
Pack = Callable[[int, int, Any], bytes]


class Declaration(Protocol):
    """One topic or service of all plugins of a class."""

    def join(self, adapter: Adapter) -> 'Endpoint':
        """Return that of the adapter's plugin.

        Raises:
            PluginError: it cannot have its name.
        """


class Endpoint:
    """One topic or service of a plugin; `Adapter` says who calls what on which thread."""

    def __init__(self, adapter: Adapter, name: str | None = None) -> None:
        self.adapter = adapter
        if name is not None:
            self.text = adapter.text(name)
            self.name = topic_name(adapter.plugin.namespace, self.text)

    def open(self) -> None:
        """Register it."""

    def refresh(self) -> None:
        """Join the plugin's output to it as long as somebody reads there."""

    def disconnect(self) -> None:
        """Let the plugin's output go nowhere."""

    def log(self, text: str) -> None:
        """Say at debug level what upstream says; {} stands for the name as it was written."""
        if text:
            logger.debug('%s%s', self.adapter.plugin.log_prefix, text.format(self.text))


@dataclass(frozen=True)
class Publishes:
    """The readings of an output become messages of a topic, while that has readers."""

    output: str
    topic: str
    message: type[Message]
    convert: Callable[[Any], Message] = lambda reading: reading  # makes a message of a reading
    frame: str | None = None  # of the header, which is then filled in; it is a name, too
    queue: int = 1
    latch: bool = False
    pack: Callable[[Adapter], Pack] | None = None  # in place of `convert`, where it must be fast
    always: bool = False  # there is the topic even if the description asks for no such output
    log: str = ''  # what is said once it is advertised

    def join(self, adapter: Adapter) -> 'PublishedTopic':
        """Return the topic of the adapter's plugin."""
        return PublishedTopic(adapter, self)


class PublishedTopic(Endpoint):
    """A topic that takes readings from an output, if the plugin has it."""

    _pack: Pack | None = None

    def __init__(self, adapter: Adapter, declared: Publishes) -> None:
        super().__init__(adapter, declared.topic)
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
        if declared.pack is not None:
            self._pack = declared.pack(adapter)
        self._clock = adapter.server.world.clock
        self.publisher = adapter.advertise(
            self.name, declared.message, declared.queue, declared.latch)
        self.log(declared.log)

    @property
    def has_output(self) -> bool:
        """Tell whether the description asks for the output."""
        return self._output is not None

    def is_wanted(self) -> bool:
        """Tell whether somebody reads it."""
        return has_readers(self.publisher)

    def refresh(self) -> None:
        """Take readings as long as somebody reads."""
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
        """Take no readings any more."""
        if self._output is not None and self._connected:
            self._output.disconnect(self.send)
        self._connected = False

    def send(self, reading: object) -> None:
        """Publish a reading."""
        publisher: rospy.Publisher = self.publisher
        now_ns = self._clock.now_ns
        if self._pack is not None:
            publish_serialized(publisher, self._pack(next_number(publisher), now_ns, reading))
            return
        message = self.declared.convert(reading)
        if self.declared.frame is not None:
            message.header.stamp, message.header.frame_id = stamp(now_ns), self._frame
        publisher.publish(message)


@dataclass(frozen=True)
class Subscribes:
    """The messages of a topic become calls of a method of the plugin, between two steps."""

    topic: str
    message: type[Message]
    call: str  # the method
    # Gives its arguments, or raises ValueError that tells why not.
    read: Callable[[Message], tuple[Any, ...]]
    queue: int = 1
    log_before: str = ''  # what is said before it is subscribed to
    log: str = ''  # and afterwards

    def join(self, adapter: Adapter) -> 'SubscribedTopic':
        """Return the topic of the adapter's plugin."""
        return SubscribedTopic(adapter, self)


class SubscribedTopic(Endpoint):
    """A topic that commands a plugin; what cannot be read is dropped, and the last one stays."""

    def __init__(self, adapter: Adapter, declared: Subscribes) -> None:
        super().__init__(adapter, declared.topic)
        self._declared = declared
        self._complained = -math.inf

    def open(self) -> None:
        """Subscribe to it."""
        declared = self._declared
        self.log(declared.log_before)
        self.adapter.subscribe(self.name, declared.message, self._take, declared.queue)
        self.log(declared.log)

    def _take(self, message: Message) -> None:
        plugin, declared = self.adapter.plugin, self._declared
        try:
            arguments = declared.read(message)
        except ValueError as error:
            if time.monotonic() > self._complained + COMPLAINT_PERIOD:
                self._complained = time.monotonic()
                logger.error('%sdropped a command on %s with %s',
                             plugin.log_prefix, self.text, error)
        else:
            self.adapter.server.loop.post(lambda: getattr(plugin, declared.call)(*arguments))


def finite(*fields: str) -> Callable[[Message], tuple[float, ...]]:
    """Return what reads numbers of a message, such as 'linear.x', and wants them to be finite."""
    getters = [attrgetter(field) for field in fields]

    def read(message: Message) -> tuple[float, ...]:
        numbers = tuple(get(message) for get in getters)
        bad = [f'{field} {number}' for field, number in zip(fields, numbers, strict=True)
               if not math.isfinite(number)]
        if bad:
            raise ValueError(f'{" and ".join(bad)}; it takes finite numbers')
        return numbers

    return read


@dataclass(frozen=True)
class Offers:
    """Something else of ROS that lives as long as the plugin, such as a service."""

    name: str
    make: Callable[[Adapter, str], Callable[[], None]]  # offers it, and returns what ends that

    def join(self, adapter: Adapter) -> 'Offered':
        """Return that of the adapter's plugin."""
        return Offered(adapter, self)


class Offered(Endpoint):
    """What is offered."""

    def __init__(self, adapter: Adapter, declared: Offers) -> None:
        super().__init__(adapter, declared.name)
        self._declared = declared

    def open(self) -> None:
        """Offer it."""
        self.adapter.on_close(self._declared.make(self.adapter, self.name))
