"""Sends messages on the publishing thread, and never waits for a reader.

rospy hands each message to a thread of the reader's connection and yields to it. The context
switches cost several times as much as sending. Each system call to send costs as much as ten steps,
whatever its size.
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

_MAX_SEQ = 0xFFFFFFFF  # of `seq`, which then wraps to 0


class BatchedPublishing:
    """The connections to all readers of this process."""

    def __init__(self) -> None:
        self.lock = threading.RLock()  # closing a connection may log, and so publish
        self.batching = False
        self.filled: list[BatchedConnection] = []  # those with collected messages

    def serve_publishers(self) -> None:
        """Use `BatchedConnection` for all publishers of this process; call once before `init_node`.

        rospy has no public API for this.
        """
        rospy.topics.QueuedConnection = lambda *arguments: BatchedConnection(self, *arguments)

    @contextlib.contextmanager
    def batched(self) -> Iterator[None]:
        """Collect published messages, and send them at the end in one call for each subscriber."""
        self.batching = True
        try:
            yield
        finally:
            with self.lock:
                self.batching = False
                for connection in self.filled:
                    connection.flush()
                self.filled.clear()


class BatchedConnection:
    """A subscriber's connection, in place of rospy's QueuedConnection.

    If the socket's buffer is full, a temporary thread sends the rest. Meanwhile the newest
    `queue_size` messages are queued; 0 means no limit.
    """

    def __init__(
        self, publishing: BatchedPublishing, connection: TCPROSTransport, queue_size: int
    ) -> None:
        self._publishing = publishing
        self._connection = connection
        self._batch: list[bytes] = []
        self._waiting: deque[bytes] = deque(maxlen=queue_size or None)
        self._draining = False

    def __getattr__(self, name: str) -> object:
        """Delegate all else to the connection."""
        return getattr(self._connection, name)

    def write_data(self, data: bytes) -> bool:
        """Send a message now, at the end of a batch, or after those already queued.

        Raises:
            TransportTerminated: the subscriber has disconnected.
        """
        if self._connection.done:
            raise TransportTerminated('connection closed')
        with self._publishing.lock:
            if self._draining:
                self._waiting.append(data)
            elif self._publishing.batching:
                if not self._batch:
                    self._publishing.filled.append(self)
                self._batch.append(data)
            else:
                self._send(data)
        return True

    def flush(self) -> None:
        """Send the collected messages; the caller holds the lock."""
        data = b''.join(self._batch)
        self._batch.clear()
        self._send(data)

    def _send(self, data: bytes) -> None:
        """Send without blocking, and leave the rest to a thread."""
        connection = self._connection
        try:
            sent = connection.socket.send(data, socket.MSG_DONTWAIT)
        except BlockingIOError:
            sent = 0
        except (OSError, AttributeError):  # no socket if another thread has closed it
            connection.close()  # the next write raises
            return
        connection.stat_bytes += sent
        connection.stat_num_msg += 1
        if sent < len(data):
            self._draining = True
            threading.Thread(target=self._drain, args=(data[sent:],), daemon=True).start()

    def _drain(self, data: bytes) -> None:
        """Send the rest and the queue, waiting for the subscriber."""
        while True:
            try:
                self._connection.write_data(data)
            except Exception as error:
                logger.debug('%s stopped reading: %s', self._connection.endpoint_id, error)
                self._connection.close()
                return
            with self._publishing.lock:
                if not self._waiting:
                    self._draining = False
                    return
                data = b''.join(self._waiting)
                self._waiting.clear()


class SubscriberWatch(rospy.SubscribeListener):  # type: ignore[misc]  # rospy has no types
    """Calls `changed()` when a subscriber connects or disconnects, on any thread."""

    def __init__(self, changed: Callable[[], None]) -> None:
        self._changed = changed

    def peer_subscribe(self, _topic: str, _publish: object, _publish_to_one: object) -> None:
        """Report a new subscriber."""
        self._changed()

    def peer_unsubscribe(self, _topic: str, _count: int) -> None:
        """Report that a subscriber has disconnected."""
        self._changed()


def stop_publishing(publisher: rospy.Publisher, watch: SubscriberWatch) -> None:
    """Unregister a publisher and its watch; others of this node may share the topic.

    rospy would keep calling the watch.
    """
    topic = publisher.impl
    if topic is not None and topic.subscriber_listeners:
        others = [listener for listener in topic.subscriber_listeners if listener is not watch]
        topic.subscriber_listeners = others  # a copy: another thread may iterate
    publisher.unregister()


def has_subscribers(publisher: rospy.Publisher | None) -> bool:
    """Tell whether a topic has subscribers; None stands for a disabled topic.

    rospy's get_num_connections takes a lock, which is slow if each robot calls it at 100 Hz.
    """
    topic = publisher.impl if publisher is not None else None
    return topic is not None and bool(topic.connections)


def subscriber_names(publisher: rospy.Publisher) -> set[str]:
    """Return the names of the subscribed nodes."""
    topic = publisher.impl
    return {connection.endpoint_id for connection in topic.connections} if topic else set()


def next_number(publisher: rospy.Publisher) -> int:
    """Return the next `seq` for a header of the publisher, and count it as rospy does."""
    topic = publisher.impl
    if topic is None:  # the node is shutting down
        return 0
    topic.seq = (topic.seq + 1) & _MAX_SEQ
    return int(topic.seq)


def publish_serialized(publisher: rospy.Publisher, messages: bytes) -> None:
    """Publish serialized messages, each with its length prefix.

    Only one thread may use this for a topic. rospy has no public API for this: it serializes one
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
