"""Keeps faulty connections from blocking all others.

rospy reads the header of each incoming connection on the accepting thread, without a timeout, and
stops accepting for good when the process is out of file descriptors. So all topics and services of
the simulator could be blocked by a client that connects and sends nothing, by the master's call to
a dead node whose port is ours now, or by a client that opens too many connections.
"""

import logging
import select
import socket
import struct
import threading
import time

from rospy.impl.tcpros_base import TCPServer

logger = logging.getLogger(__name__)

TIMEOUT = 10.0  # how long a new connection may take to send its header [s, wall]
# Limit of a header [bytes]. The whole header must fit in the socket's buffer; a client's header
# contains a message definition at most. Text of other protocols decodes to a far greater length.
MAX_HEADER_SIZE = 1 << 15
_LENGTH = struct.Struct('<I')  # length prefix [bytes]
# Between polls of an incomplete header [s, wall]; each pause is twice the previous one.
_FIRST_PAUSE, _MAX_PAUSE = 0.001, 0.1
_WAITING = 128  # listen backlog; rospy's 5 are too few during a launch
_SHORTAGE = 0.1  # pause without file descriptors [s, wall]


def guard_handshakes() -> None:
    """Handle each connection on a separate thread; call once before `init_node`.

    rospy has no public API for this.
    """
    TCPServer.run = accept_connections


def accept_connections(server: TCPServer) -> None:
    """Accept connections until `server` is shut down, despite errors of single ones."""
    server.server_sock.listen(_WAITING)
    complained = False
    while not server.is_shutdown:
        try:
            connection, address = server.server_sock.accept()
            threading.Thread(
                target=_receive, args=(server, connection, address), daemon=True
            ).start()
            complained = False
        except (OSError, RuntimeError) as error:  # out of file descriptors or threads
            if not (complained or server.is_shutdown):
                logger.warning('cannot accept connections at the moment: %s', error)
            complained = True
            time.sleep(_SHORTAGE)


def _receive(server: TCPServer, connection: socket.socket, address: tuple[str, int]) -> None:
    """Hand a connection to rospy if it speaks TCPROS, else close it."""
    if speaks_tcpros(connection):
        server.inbound_handler(connection, address)
    else:
        logger.debug('rejected a connection from %s that is not TCPROS', address)
        connection.close()


def speaks_tcpros(connection: socket.socket, timeout: float = TIMEOUT) -> bool:
    """Tell whether a complete header arrives within `timeout` [s, wall]; consumes nothing."""
    deadline = time.monotonic() + timeout
    pause = _FIRST_PAUSE
    hangup = select.poll()
    hangup.register(connection, select.POLLRDHUP)
    while True:
        connection.settimeout(max(_FIRST_PAUSE, deadline - time.monotonic()))
        try:
            there = connection.recv(_LENGTH.size + MAX_HEADER_SIZE, socket.MSG_PEEK)
        except OSError:
            return False
        if len(there) >= _LENGTH.size:
            (length,) = _LENGTH.unpack_from(there)
            if length > MAX_HEADER_SIZE:
                return False
            if len(there) >= _LENGTH.size + length:
                connection.settimeout(None)
                return True
        if not there or time.monotonic() >= deadline or hangup.poll(1000.0 * pause):
            return False
        pause = min(2.0 * pause, _MAX_PAUSE)
