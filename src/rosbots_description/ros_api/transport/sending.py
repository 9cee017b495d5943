"""Sends messages from the thread that publishes them, and never waits for a reader.

rospy hands every message to a thread of the reader's connection and yields to it. The two threads
wake each other for each message, which costs several times what sending it does; and to the system
each send costs as much as ten steps, however little it sends.
"""

import contextlib
import logging
import socket
import threading
from collections import deque
from collections.abc import Callable, Iterator

import rospy
import rospy.topics
from rospy.exceptions import TransportTerminated
from rospy.impl.tcpros_base import TCPROSTransport

logger = logging.getLogger(__name__)

_LARGEST_NUMBER = 0xFFFFFFFF  # that a header has room for; then it begins at 0 again


class Outlets:
    """The connections to all readers of this process."""

    def __init__(self) -> None:
        self.lock = threading.RLock()  # closing a connection may log, and so publish
        self.gathering = False
        self.filled: list[Outlet] = []  # those that have gathered something

    def serve_publishers(self) -> None:
        """Let all publishers of this process send so; call once before `init_node`.

        rospy has no public place for this.
        """
        rospy.topics.QueuedConnection = lambda *arguments: Outlet(self, *arguments)

    @contextlib.contextmanager
    def gathered(self) -> Iterator[None]:
        """Send what is published meanwhile at the end, to each reader in one piece."""
        self.gathering = True
        try:
            yield
        finally:
            with self.lock:
                self.gathering = False
                for outlet in self.filled:
                    outlet.flush()
                self.filled.clear()


class Outlet:
    """A reader's connection, in the place of rospy's QueuedConnection.

    What the reader has no room for now waits for a thread that lives only until all is sent. Of the
    messages that come meanwhile the newest `queue_size` wait, too; 0 means any number.
    """

    def __init__(self, outlets: Outlets, connection: TCPROSTransport, queue_size: int) -> None:
        self._outlets = outlets
        self._connection = connection
        self._gathered: list[bytes] = []
        self._waiting: deque[bytes] = deque(maxlen=queue_size or None)
        self._draining = False

    def __getattr__(self, name: str) -> object:
        """Be the connection in everything else."""
        return getattr(self._connection, name)

    def write_data(self, data: bytes) -> bool:
        """Send a message now, with others at the end of a batch, or after those that wait already.

        Raises:
            TransportTerminated: the reader has gone.
        """
        if self._connection.done:
            raise TransportTerminated('connection closed')
        with self._outlets.lock:
            if self._draining:
                self._waiting.append(data)
            elif self._outlets.gathering:
                if not self._gathered:
                    self._outlets.filled.append(self)
                self._gathered.append(data)
            else:
                self._send(data)
        return True

    def flush(self) -> None:
        """Send what was gathered; the caller holds the lock."""
        data = b''.join(self._gathered)
        self._gathered.clear()
        self._send(data)

    def _send(self, data: bytes) -> None:
        """Send what there is room for, and leave the rest to a thread."""
        connection = self._connection
        try:
            sent = connection.socket.send(data, socket.MSG_DONTWAIT)
        except BlockingIOError:
            sent = 0
        except (OSError, AttributeError):  # closed meanwhile by another thread it has no socket
            connection.close()  # the next message hears of it
            return
        connection.stat_bytes += sent
        connection.stat_num_msg += 1
        if sent < len(data):
            self._draining = True
            threading.Thread(target=self._drain, args=(data[sent:],), daemon=True).start()

    def _drain(self, data: bytes) -> None:
        """Send the rest, and what came meanwhile, at the pace of the reader."""
        while True:
            try:
                self._connection.write_data(data)
            except Exception as error:
                logger.debug('%s stopped reading: %s', self._connection.endpoint_id, error)
                self._connection.close()
                return
            with self._outlets.lock:
                if not self._waiting:
                    self._draining = False
                    return
                data = b''.join(self._waiting)
                self._waiting.clear()


class ReaderWatch(rospy.SubscribeListener):
    """Calls `changed()` whenever a reader of a topic has come or gone, on whatever thread."""

    def __init__(self, changed: Callable[[], None]) -> None:
        self._changed = changed

    def peer_subscribe(self, _topic: str, _publish: object, _publish_to_one: object) -> None:
        """Tell of a new reader."""
        self._changed()

    def peer_unsubscribe(self, _topic: str, _count: int) -> None:
        """Tell of one less."""
        self._changed()


def stop_publishing(publisher: rospy.Publisher, watch: ReaderWatch) -> None:
    """Publish no more; other publishers of this node may go on with the topic.

    rospy would then go on telling the watch of readers.
    """
    topic = publisher.impl
    if topic is not None and topic.subscriber_listeners:
        others = [listener for listener in topic.subscriber_listeners if listener is not watch]
        topic.subscriber_listeners = others  # another thread may be telling those there were
    publisher.unregister()


def has_readers(publisher: rospy.Publisher | None) -> bool:
    """Tell whether anybody reads a topic; None is one that was left out.

    What rospy offers for it takes a lock, which matters where every robot asks at 100 Hz.
    """
    topic = publisher.impl if publisher is not None else None
    return topic is not None and bool(topic.connections)


def reader_names(publisher: rospy.Publisher) -> set[str]:
    """Return the names of the nodes that read a topic."""
    topic = publisher.impl
    return {connection.endpoint_id for connection in topic.connections} if topic else set()


def next_number(publisher: rospy.Publisher) -> int:
    """Return what the header of the publisher's next message has as `seq`, as rospy counts."""
    topic = publisher.impl
    if topic is None:  # the node is shutting down
        return 0
    topic.seq = (topic.seq + 1) & _LARGEST_NUMBER
    return topic.seq


def publish_serialized(publisher: rospy.Publisher, messages: bytes) -> None:
    """Publish messages that are serialized, each behind its size, as they go over the wire.

    Only one thread may publish on a topic so. rospy has no public place for this: it serializes a
    message at a time.
    """
    topic = publisher.impl
    if topic is None:  # the node is shutting down
        return
    topic.message_data_sent += len(messages)
    for connection in topic.connections:
        try:
            connection.write_data(messages)
        except TransportTerminated:
            connection.close()
