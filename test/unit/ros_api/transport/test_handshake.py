"""Connections that do not speak TCPROS are recognised and delay no other connection."""

import errno
import os
import select
import socket
import struct
import threading
import time

import pytest
from support.patience import PATIENCE, wait_until

from rosbots_description.ros_api.transport.handshake import (
    MAX_HEADER_SIZE,
    accept_connections,
    speaks_tcpros,
)

TIMEOUT = 0.05  # [s]
PARTIAL = struct.pack('<I', 7) + b'a='  # of a header


@pytest.fixture
def ends():
    pair = socket.socketpair()
    yield pair
    for end in pair:
        end.close()


def test_header_is_recognised_without_consuming_it(ends):
    ours, theirs = ends
    header = struct.pack('<II', 7, 3) + b'a=b'
    theirs.sendall(header)
    assert speaks_tcpros(ours, TIMEOUT)
    assert ours.gettimeout() is None
    assert ours.recv(100) == header


def test_available_header_is_accepted_without_a_pause(ends, monkeypatch):
    class Poll:
        def register(self, _connection, _events):
            pass

        def poll(self, _milliseconds):
            pytest.fail('paused')

    monkeypatch.setattr(select, 'poll', Poll)
    ends[1].sendall(struct.pack('<I', 3) + b'a=b')
    assert speaks_tcpros(ends[0], TIMEOUT)


@pytest.mark.parametrize('sent', [b'', PARTIAL])
def test_silent_connection_times_out(ends, sent):
    ends[1].sendall(sent)
    begin = time.monotonic()
    assert not speaks_tcpros(ends[0], TIMEOUT)
    assert time.monotonic() - begin >= TIMEOUT


def test_http_is_not_tcpros(ends):
    ends[1].sendall(b'POST /RPC2 HTTP/1.1\r\n')
    assert not speaks_tcpros(ends[0], TIMEOUT)


@pytest.mark.parametrize('sent', [b'', PARTIAL])
def test_closed_connection_ends_the_wait(ends, sent):
    ends[1].sendall(sent)
    ends[1].close()
    begin = time.monotonic()
    assert not speaks_tcpros(ends[0], 1000.0)
    assert time.monotonic() - begin < 500.0


def test_header_in_pieces_is_recognised_when_complete(ends):
    ours, theirs = ends
    header = struct.pack('<I', 7) + b'abc=def'
    begin = time.monotonic()
    theirs.sendall(header[:2])
    timers = [
        threading.Timer(TIMEOUT * i, theirs.sendall, [header[2 * i : 2 * i + 2]])
        for i in range(1, 5)
    ]
    timers.append(threading.Timer(TIMEOUT * 5, theirs.sendall, [header[10:]]))
    for timer in timers:
        timer.start()
    assert speaks_tcpros(ours, PATIENCE)
    assert time.monotonic() - begin >= 5 * TIMEOUT
    assert ours.recv(100) == header


@pytest.mark.parametrize(
    ('length', 'taken'), [(MAX_HEADER_SIZE, True), (MAX_HEADER_SIZE + 1, False)]
)
def test_length_of_a_header_is_limited(ends, length, taken):
    ours, theirs = ends
    theirs.sendall(struct.pack('<I', length) + b'x' * length)
    assert speaks_tcpros(ours, PATIENCE) == taken


class Listener:
    """A rospy server whose listening socket returns the given outcomes, then shuts down."""

    def __init__(self, *outcomes):
        self.server_sock, self.is_shutdown = self, False
        self.received = []
        self._outcomes = list(outcomes)

    def listen(self, _backlog):
        pass

    def accept(self):
        outcome = self._outcomes.pop(0)
        self.is_shutdown = not self._outcomes
        if isinstance(outcome, OSError):
            raise outcome
        return outcome, ('localhost', 1)

    def inbound_handler(self, connection, _address):
        self.received.append(connection)


def received(listener, count):
    wait_until(lambda: len(listener.received) >= count)
    return listener.received


def test_silent_connection_delays_no_other(ends):
    silent, _ = ends
    ours, theirs = socket.socketpair()
    with ours, theirs:
        theirs.sendall(struct.pack('<I', 3) + b'a=b')
        listener = Listener(silent, ours)
        accept_connections(listener)
        assert received(listener, 1) == [ours]


def test_connections_are_accepted_again_after_running_out_of_files(ends, caplog):
    ours, theirs = ends
    theirs.sendall(struct.pack('<I', 3) + b'a=b')
    shortage = OSError(errno.EMFILE, os.strerror(errno.EMFILE))
    listener = Listener(shortage, shortage, ours)
    accept_connections(listener)
    assert received(listener, 1) == [ours]
    (record,) = caplog.records
    assert 'cannot accept connections at the moment: [Errno 24] Too many' in record.message
