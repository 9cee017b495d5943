"""Keeps one odd connection from blocking all others.

rospy reads the header of each incoming connection on the thread that accepts them, and waits
without limit. A client that connects and says nothing, or the master's call to a node that died
and whose port is now ours, would make every topic and service of the simulator unreachable.
"""

import logging
import socket
import struct

from rospy.impl import tcpros_base

logger = logging.getLogger(__name__)

PATIENCE = 1.0  # how long a new connection may be silent [s, wall]
LONGEST_HEADER = 1 << 20  # [bytes]; text of another protocol reads as far more


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
    """Tell whether the connection begins with the length of a header; nothing is consumed."""
    connection.settimeout(patience)
    try:
        start = connection.recv(4, socket.MSG_PEEK | socket.MSG_WAITALL)
    except OSError:
        return False
    connection.settimeout(None)
    return len(start) == 4 and struct.unpack('<I', start)[0] <= LONGEST_HEADER
