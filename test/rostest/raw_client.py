"""Misbehaving clients: raw bytes of TCPROS, and connections of killed processes."""

import socket
import struct
from io import BytesIO
from urllib.parse import urlparse

import rosgraph
from rosgraph.network import read_ros_handshake_header, write_ros_handshake_header
from simulator import DEADLINE

BUFFER = 4096  # [bytes]


def connection(receive_buffer=None, master=None):
    """Return a new connection to the port at which the server offers services and topics."""
    uri = rosgraph.Master('/raw_client', master).lookupService('/gazebo/get_world_properties')
    made = socket.socket()
    if receive_buffer:
        made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
    made.settimeout(2 * DEADLINE)
    made.connect((urlparse(uri).hostname, urlparse(uri).port))
    return made


def greet(made, header):
    """Exchange headers as a client with this one; return the connection."""
    write_ros_handshake_header(made, {'callerid': '/raw_client', **header})
    read_ros_handshake_header(made, BytesIO(), BUFFER)
    return made


def service_connection(name, service_class, master=None, **header):
    wanted = {'service': f'/gazebo/{name}', 'md5sum': service_class._md5sum}
    return greet(connection(master=master), {**wanted, **header})


def request_bytes(request):
    buffer = BytesIO()
    request.serialize(buffer)
    return struct.pack('<I', buffer.tell()) + buffer.getvalue()


def answer(made, service_class):
    """Return the response to a request that was sent."""
    with made.makefile('rb') as file:
        succeeded, length = struct.unpack('<BI', file.read(5))
        content = file.read(length)
    assert succeeded, content
    return service_class._response_class().deserialize(content)


def deaf_subscriber(topic, message_class):
    """Return a connection that subscribes to a topic and never reads, like a stopped process."""
    header = {'topic': topic, 'md5sum': message_class._md5sum, 'type': message_class._type}
    return greet(connection(BUFFER), header)


def vanish(made):
    """Reset a connection, as the kernel does for a killed process."""
    made.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack('ii', 1, 0))
    made.close()


def unsent_bytes(made):
    """Return the number of bytes in the kernel's send queue of the server for a connection."""
    ours, theirs = made.getsockname()[1], made.getpeername()[1]
    with open('/proc/net/tcp', encoding='ascii') as table:
        for line in table.readlines()[1:]:
            fields = line.split()
            local, remote = (int(field.rpartition(':')[2], 16) for field in fields[1:3])
            if (local, remote) == (theirs, ours):
                return int(fields[4].partition(':')[0], 16)
    return 0
