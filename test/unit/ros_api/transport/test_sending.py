"""Messages are sent on the publisher's thread; a slow subscriber loses whole messages only."""

import socket

import pytest
from rospy.exceptions import TransportTerminated
from rospy.impl.tcpros_base import TCPROSTransport, TCPROSTransportProtocol
from support.patience import PATIENCE, wait_until

from rosbots_description.ros_api.adapters import cameras
from rosbots_description.ros_api.transport.sending import BatchedConnection, BatchedPublishing
from rosbots_description.sim.sensors import MAX_BURST

SIZE = 1000  # of a message [bytes]; it repeats one byte


@pytest.fixture
def wire():
    """Yield the outlets of a process and both ends of a connection with small buffers."""
    ours, theirs = socket.socketpair()
    ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 10 * SIZE)
    theirs.settimeout(PATIENCE)
    transport = TCPROSTransport(TCPROSTransportProtocol('t', None), 't')
    transport.set_socket(ours, 'reader')
    yield BatchedPublishing(), transport, theirs
    transport.close()
    theirs.close()


def message(number):
    return bytes([number]) * SIZE


def read(theirs, until):
    """Return the numbers of the messages that arrive, up to the message `until`."""
    numbers = []
    with theirs.makefile('rb', buffering=0) as stream:
        while not numbers or numbers[-1] != until:
            data = b''
            while len(data) < SIZE:
                data += stream.read(SIZE - len(data))
            assert data == message(data[0]), 'a message is incomplete'
            numbers.append(data[0])
    return numbers


def test_message_is_sent_before_publish_returns(wire):
    outlets, transport, theirs = wire
    BatchedConnection(outlets, transport, 1).write_data(message(7))
    theirs.setblocking(False)
    assert theirs.recv(2 * SIZE) == message(7)


def test_messages_of_a_batch_are_sent_at_its_end_in_order(wire):
    outlets, transport, theirs = wire
    outlet = BatchedConnection(outlets, transport, 1)
    with outlets.batched():
        for number in (1, 2, 3):
            outlet.write_data(message(number))
        theirs.setblocking(False)
        with pytest.raises(BlockingIOError):
            theirs.recv(SIZE)
    assert theirs.recv(10 * SIZE) == message(1) + message(2) + message(3)


@pytest.mark.parametrize('batch', [1, 5])
@pytest.mark.parametrize('queue', [1, 4, 0])
def test_stopped_subscriber_blocks_nobody_and_loses_only_whole_messages(wire, queue, batch):
    outlets, transport, theirs = wire
    outlet = BatchedConnection(outlets, transport, queue)
    for first in range(0, 200, batch):  # nothing reads: one that blocked would never end
        with outlets.batched():
            for number in range(first, first + batch):
                outlet.write_data(message(number))
    numbers = read(theirs, until=199)
    assert numbers == sorted(set(numbers))
    assert (len(numbers) == 200) == (queue == 0)
    _wait_until_drained(outlet, theirs, 200)


@pytest.fixture
def picture_wire():
    """Yield the outlets of a process and both ends of a connection, as rospy makes it."""
    listener = socket.create_server(('localhost', 0))
    theirs = socket.create_connection(listener.getsockname(), PATIENCE)
    ours, _ = listener.accept()
    listener.close()
    transport = TCPROSTransport(TCPROSTransportProtocol('t', None), 't')
    transport.set_socket(ours, 'reader')
    yield BatchedPublishing(), transport, theirs
    transport.close()
    theirs.close()


@pytest.mark.parametrize('size', [800 * 800 * 3, 1920 * 1080 * 3, 60_000])  # the last one a JPEG
def test_a_reader_that_keeps_up_loses_no_picture(picture_wire, size):
    """It has read all before the next burst, of as many pictures as may be drawn at a time."""
    outlets, transport, theirs = picture_wire
    outlet = BatchedConnection(outlets, transport, cameras.QUEUE)
    numbers = iter(range(256))
    with theirs.makefile('rb') as stream:
        for burst in [1, 2, MAX_BURST, 1, MAX_BURST] * 4:
            sent = [bytes([next(numbers)]) * size for _ in range(1 + burst)]
            outlet.write_data(sent[0])  # it is being sent while the others are drawn
            with outlets.batched():
                for picture in sent[1:]:
                    outlet.write_data(picture)
            assert [stream.read(size) for _ in sent] == sent


def _wait_until_drained(outlet, theirs, number):
    """Assert that messages arrive at once again."""
    wait_until(lambda: not outlet._draining)
    outlet.write_data(message(number))
    assert read(theirs, until=number) == [number]


@pytest.mark.parametrize('queue', [1, 0])
def test_disconnected_subscriber_is_reported_to_the_publisher(wire, queue):
    outlets, transport, theirs = wire
    outlet, closed = BatchedConnection(outlets, transport, queue), []
    outlet.set_cleanup_callback(closed.append)
    theirs.close()
    outlet.write_data(message(1))
    assert closed == [transport]
    with pytest.raises(TransportTerminated):
        outlet.write_data(message(2))
