"""Waits until the messages that have arrived at this process are delivered.

Messages and requests travel on connections of their own, each with a thread that reads it: a
request may overtake a message that was sent before it.
"""

import contextlib
import fcntl
import socket
import struct
import termios
import time
from collections.abc import Iterable
from weakref import WeakSet

from rospy.impl.registration import get_topic_manager
from rospy.impl.tcpros_base import TCPROSTransport

PATIENCE = 5.0  # [s, wall] for callbacks that hang
_PAUSE = 0.0002  # [s, wall]
_delivering: WeakSet[socket.socket] = WeakSet()  # their data is read, and may not be delivered yet


def await_data(connection: socket.socket) -> None:
    """Wait until a connection has data to read; what was read of it before has been delivered."""
    _delivering.discard(connection)
    with contextlib.suppress(OSError):  # who reads the data reports it
        connection.recv(1, socket.MSG_PEEK)
    _delivering.add(connection)


def subscribed_connections() -> list[TCPROSTransport]:
    """Return the connections to the publishers of all topics that this node subscribes to."""
    topics = tuple(get_topic_manager().subs.values())  # other threads may add some meanwhile
    return [connection for topic in topics for connection in topic.connections]


def wait_for_delivery(connections: Iterable[TCPROSTransport]) -> bool:
    """Wait until the callbacks of all messages that have arrived by now have returned.

    Returns:
        whether they have, within `PATIENCE`.
    """
    arrived = [(each, each.stat_bytes + _unread(each.socket)) for each in connections]
    end = time.monotonic() + PATIENCE
    while any(not _is_delivered(each, size) for each, size in arrived):
        if time.monotonic() > end:
            return False
        time.sleep(_PAUSE)
    return True


def _is_delivered(connection: TCPROSTransport, size: int) -> bool:
    """Tell whether the first `size` bytes are delivered, as more were read, or all there are."""
    ours = connection.socket
    is_idle = not _unread(ours) and ours not in _delivering  # in this order: see await_data
    return bool(is_idle or connection.stat_bytes > size)


def _unread(connection: socket.socket | None) -> int:
    """Return how many bytes have arrived and are not read; 0 of a closed connection."""
    if connection is None:
        return 0
    try:
        return int(struct.unpack('i', fcntl.ioctl(connection, termios.FIONREAD, bytes(4)))[0])
    except (OSError, ValueError):
        return 0
