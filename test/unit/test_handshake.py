"""Connections that do not speak TCPROS are told apart, and nothing is taken from the others."""

import socket
import struct
import threading
import time

import pytest

from rosbots_description.ros_api.handshake import LONGEST_HEADER, speaks_tcpros

PATIENCE = 0.05  # [s]


@pytest.fixture
def ends():
    pair = socket.socketpair()
    yield pair
    for end in pair:
        end.close()


def test_a_header_is_recognised_and_left_to_be_read(ends):
    ours, theirs = ends
    header = struct.pack('<II', 7, 3) + b'a=b'
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


def test_a_header_that_does_not_come_is_not_waited_for(ends):
    ends[1].sendall(struct.pack('<I', 7) + b'a=')
    begin = time.monotonic()
    assert not speaks_tcpros(ends[0], PATIENCE)
    assert time.monotonic() - begin >= PATIENCE


def test_a_header_in_pieces_is_recognised_when_it_is_whole(ends):
    ours, theirs = ends
    header = struct.pack('<I', 7) + b'abc=def'
    begin = time.monotonic()
    theirs.sendall(header[:2])
    timers = [threading.Timer(PATIENCE * i, theirs.sendall, [header[2 * i : 2 * i + 2]])
              for i in range(1, 5)]
    timers.append(threading.Timer(PATIENCE * 5, theirs.sendall, [header[10:]]))
    for timer in timers:
        timer.start()
    assert speaks_tcpros(ours, 100 * PATIENCE)
    assert time.monotonic() - begin >= 5 * PATIENCE
    assert ours.recv(100) == header


@pytest.mark.parametrize(('length', 'taken'), [(LONGEST_HEADER, True), (LONGEST_HEADER + 1, False)])
def test_a_header_has_a_greatest_length(ends, length, taken):
    ours, theirs = ends
    theirs.sendall(struct.pack('<I', length) + b'x' * length)
    assert speaks_tcpros(ours, 100 * PATIENCE) == taken
