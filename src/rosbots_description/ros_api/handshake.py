"""Keeps one odd connection from blocking all others.

rospy reads the header of each incoming connection on the thread that accepts them, and waits
without limit. A client that connects and says nothing, or the master's call to a node that died
and whose port is now ours, would make every topic and service of the simulator unreachable.
"""

import logging
import socket
import struct
import time

from rospy.impl import tcpros_base

logger = logging.getLogger(__name__)

PATIENCE = 1.0  # how long a new connection may take to send its header [s, wall]
# Of a header [bytes]. It waits in the socket's buffer as a whole, so it must fit in there; those of
# real clients hold a message definition at most. Text of another protocol reads as far more.
LONGEST_HEADER = 1 << 15
_LENGTH = struct.Struct('<I')  # what a header begins with: how many bytes follow
_PAUSE = 0.001  # between two looks at a header that comes in pieces [s, wall]


def guard_handshakes() -> None:
    """Turn away connections that do not speak TCPROS; call once after `init_node`.

    rospy has no public place for this.
    """
    tcpros_base.start_tcpros_server()
    server = tcpros_base._tcpros_server.tcp_ros_server
    accept = server.inbound_handler

    def accept_tcpros(connection: socket.socket, address: tuple) -> None:
        if speaks_tcpros(connection):
            accept(connection, address)
        else:
            logger.debug('turned away a connection from %s that is not TCPROS', address)
            connection.close()

    server.inbound_handler = accept_tcpros


def speaks_tcpros(connection: socket.socket, patience: float = PATIENCE) -> bool:
    """Tell whether a whole header arrives within `patience` [s, wall]; nothing is consumed."""
    deadline = time.monotonic() + patience
    wanted = _LENGTH.size
    while True:
        connection.settimeout(max(_PAUSE, deadline - time.monotonic()))
        try:
            # With a timeout Python's recv returns what is there, whatever MSG_WAITALL says.
            there = connection.recv(wanted, socket.MSG_PEEK)
        except OSError:
            return False
        if len(there) >= _LENGTH.size:
            (length,) = _LENGTH.unpack_from(there)
            if length > LONGEST_HEADER:
                return False
            wanted = _LENGTH.size + length
            if len(there) == wanted:
                connection.settimeout(None)
                return True
        if not there or time.monotonic() >= deadline:
            return False
        time.sleep(_PAUSE)
