"""Keep faulty connections from blocking all others.

rospy reads the header of each incoming connection on the thread that accepts them, waits without
limit, and stops accepting for good when no more files can be opened. A client that connects and
says nothing, the master's call to a node that died and whose port is now ours, or one that opens
connections without end would make every topic and service of the simulator unreachable.
"""

import logging
import select
import socket
import struct
import threading
import time

from rospy.impl.tcpros_base import TCPServer

logger = logging.getLogger(__name__)

PATIENCE = 10.0  # how long a new connection may take to send its header [s, wall]
# Of a header [bytes]. It waits in the socket's buffer as a whole, so it must fit in there; those of
# real clients hold a message definition at most. Text of another protocol reads as far more.
LONGEST_HEADER = 1 << 15
_LENGTH = struct.Struct('<I')  # what a header begins with: how many bytes follow
# Between two looks at a header that comes in pieces [s, wall]; each pause is twice the one before.
_FIRST_PAUSE, _LONGEST_PAUSE = 0.001, 0.1
_WAITING = 128  # connections that may wait to be accepted; rospy's 5 are few when a launch begins
_SHORTAGE = 0.1  # until somebody may have closed a file [s, wall]


def guard_handshakes() -> None:
    """Receive each connection on a thread of its own; call once before `init_node`.

    rospy has no public place for this.
    """
    TCPServer.run = accept_connections


def accept_connections(server: TCPServer) -> None:
    """Accept connections until `server` is shut down, whatever happens to one of them."""
    server.server_sock.listen(_WAITING)
    complained = False
    while not server.is_shutdown:
        try:
            connection, address = server.server_sock.accept()
            threading.Thread(
                target=_receive, args=(server, connection, address), daemon=True
            ).start()
            complained = False
        except (OSError, RuntimeError) as error:  # no more files, or no more threads
            if not (complained or server.is_shutdown):
                logger.warning('cannot accept connections at the moment: %s', error)
            complained = True
            time.sleep(_SHORTAGE)


def _receive(server: TCPServer, connection: socket.socket, address: tuple) -> None:
    """Let rospy have a connection that speaks TCPROS, and turn away any other."""
    if speaks_tcpros(connection):
        server.inbound_handler(connection, address)
    else:
        logger.debug('rejected a connection from %s that is not TCPROS', address)
        connection.close()


def speaks_tcpros(connection: socket.socket, patience: float = PATIENCE) -> bool:
    """Tell whether a whole header arrives within `patience` [s, wall]; nothing is consumed."""
    deadline = time.monotonic() + patience
    pause = _FIRST_PAUSE
    hangup = select.poll()
    hangup.register(connection, select.POLLRDHUP)
    while True:
        connection.settimeout(max(_FIRST_PAUSE, deadline - time.monotonic()))
        try:
            there = connection.recv(_LENGTH.size + LONGEST_HEADER, socket.MSG_PEEK)
        except OSError:
            return False
        if len(there) >= _LENGTH.size:
            (length,) = _LENGTH.unpack_from(there)
            if length > LONGEST_HEADER:
                return False
            if len(there) >= _LENGTH.size + length:
                connection.settimeout(None)
                return True
        if not there or time.monotonic() >= deadline or hangup.poll(1000.0 * pause):
            return False
        pause = min(2.0 * pause, _LONGEST_PAUSE)
