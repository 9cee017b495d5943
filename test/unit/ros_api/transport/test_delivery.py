"""What has arrived on a topic is delivered before a request that came later is answered."""

import socket
import struct
import threading
from io import BytesIO

import pytest
from rospy.impl import tcpros_base
from rospy.impl.tcpros_base import TCPROSTransport
from rospy.impl.tcpros_pubsub import TCPROSSub
from std_msgs.msg import String

from rosbots_description.ros_api.transport import delivery
from rosbots_description.ros_api.transport.delivery import wait_for_delivery
from rosbots_description.ros_api.transport.incoming import receive

LIMIT = 60.0  # [s, wall] ends a hopeless wait


def message(text):
    content = BytesIO()
    String(text).serialize(content)
    return struct.pack('<I', content.tell()) + content.getvalue()


class Reader:
    """A subscriber's connection, and the thread that reads it; its callback waits for leave."""

    def __init__(self):
        ours, self.theirs = socket.socketpair()
        self.connection = TCPROSTransport(TCPROSSub('/t', String), '/t')
        self.connection.set_socket(ours, 'publisher')
        self.heard, self.called, self.may_return = [], threading.Event(), threading.Event()
        self._thread = threading.Thread(
            target=self.connection.receive_loop, args=(self._hear,), daemon=True
        )
        self._thread.start()

    def _hear(self, messages, _connection):
        self.called.set()
        self.may_return.wait(LIMIT)
        self.heard += [m.data for m in messages]

    def close(self):
        self.may_return.set()
        self.theirs.close()
        self._thread.join(LIMIT)


@pytest.fixture
def reader(monkeypatch):
    monkeypatch.setattr(tcpros_base, 'recv_buff', receive)
    reader = Reader()
    yield reader
    reader.close()


def test_all_that_has_arrived_is_delivered(reader):
    reader.may_return.set()
    for number in range(200):
        reader.theirs.sendall(message(str(number)))
        assert wait_for_delivery([reader.connection])
        assert reader.heard[-1] == str(number)


def test_a_callback_that_runs_is_waited_for(reader):
    reader.theirs.sendall(message('first'))
    assert reader.called.wait(LIMIT)  # it has left the socket, and is not delivered
    threading.Timer(0.05, reader.may_return.set).start()
    assert wait_for_delivery([reader.connection])
    assert reader.heard == ['first']


def test_a_callback_that_hangs_is_given_up(reader, monkeypatch):
    monkeypatch.setattr(delivery, 'PATIENCE', 0.01)
    reader.theirs.sendall(message('first'))
    assert not wait_for_delivery([reader.connection])


def test_half_a_message_is_not_waited_for(reader):
    reader.theirs.sendall(message('first')[:-1])
    assert wait_for_delivery([reader.connection])
    assert reader.heard == []


def test_a_lost_connection_is_not_waited_for(reader):
    reader.close()
    assert wait_for_delivery([reader.connection])
