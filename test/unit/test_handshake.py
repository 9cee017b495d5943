"""Connections that do not speak TCPROS are told apart, and nothing is taken from the others."""

import socket
import struct

import pytest

from rosbots_description.ros_api.handshake import speaks_tcpros

PATIENCE = 0.05  # [s]


@pytest.fixture
def ends():
    pair = socket.socketpair()
    yield pair
    for end in pair:
        end.close()


def test_a_header_is_recognised_and_left_to_be_read(ends):
    ours, theirs = ends
    header = struct.pack('<I', 7) + b'a=b'
    theirs.sendall(header)
    assert speaks_tcpros(ours, PATIENCE)
    assert ours.gettimeout() is None
    assert ours.recv(100) == header


def test_silence_is_not_waited_for(ends):
    assert not speaks_tcpros(ends[0], PATIENCE)


def test_http_is_not_tcpros(ends):
    ends[1].sendall(b'POST /RPC2 HTTP/1.1\r\n')
    assert not speaks_tcpros(ends[0], PATIENCE)


def test_a_connection_that_ends_at_once_is_not_tcpros(ends):
    ends[1].close()
    assert not speaks_tcpros(ends[0], PATIENCE)
