"""Incoming data that is too long, malformed, or from a client that has gone."""

import socket
import struct
import threading
from io import BytesIO

import pytest
from gazebo_msgs.srv import GetModelState, GetModelStateRequest, GetModelStateResponse
from rospy.exceptions import TransportTerminated
from rospy.impl.tcpros_base import TCPROSTransport
from rospy.impl.tcpros_service import ServiceImpl

from rosbots_description.ros_api.transport.incoming import (
    MAX_MESSAGE_SIZE,
    answer,
    complain,
    receive,
    serve,
    wait_for_answers,
)

BUFFER = 4096  # [bytes]


@pytest.fixture
def ends():
    ours, theirs = socket.socketpair()
    theirs.settimeout(5.0)
    with ours, theirs:
        yield ours, theirs


@pytest.fixture
def service(monkeypatch):
    monkeypatch.setattr(ServiceImpl, 'error_handler', complain)
    return ServiceImpl(
        '~get_model_state',
        GetModelState,
        lambda request: GetModelStateResponse(status_message=request.model_name),
    )


def serve_once(service, connection):
    transport = TCPROSTransport(service.protocol, service.resolved_name)
    transport.set_socket(connection, 'client')
    serve(service, transport, {'callerid': '/client'})


def request(name):
    content = BytesIO()
    GetModelStateRequest(name, '').serialize(content)
    return struct.pack('<I', content.tell()) + content.getvalue()


def test_message_within_the_limit_is_received(ends):
    ours, theirs = ends
    theirs.sendall(struct.pack('<I', MAX_MESSAGE_SIZE) + b'beginning')
    buffer = BytesIO()
    assert receive(ours, buffer, BUFFER) == 13
    assert buffer.getvalue().endswith(b'beginning')


def test_message_beyond_the_limit_ends_the_connection(ends, caplog):
    ours, theirs = ends
    theirs.sendall(struct.pack('<I', MAX_MESSAGE_SIZE + 1))
    with pytest.raises(TransportTerminated):
        receive(ours, BytesIO(), BUFFER)
    assert f'a message of {MAX_MESSAGE_SIZE + 1} bytes is rejected' in caplog.text


def test_length_in_pieces_is_read_completely(ends):
    ours, theirs = ends
    buffer = BytesIO()
    for piece in (b'\x02\0', b'\0\0ab'):
        theirs.sendall(piece)
        receive(ours, buffer, BUFFER)
    assert buffer.getvalue() == b'\x02\0\0\0ab'


def test_valid_request_is_answered(ends, service):
    ours, theirs = ends
    theirs.sendall(request('robot'))
    serve_once(service, ours)
    assert b'robot' in theirs.recv(BUFFER)


def test_malformed_request_is_answered_with_an_error_message(ends, service, caplog):
    ours, theirs = ends
    theirs.sendall(struct.pack('<II', 4, 1000))  # a name of 1000 bytes in a request of four
    serve_once(service, ours)
    succeeded, length = struct.unpack('<BI', theirs.recv(5))
    error = theirs.recv(length).decode()
    assert not succeeded
    assert error.startswith('the request does not fit gazebo_msgs/GetModelState')
    assert error in caplog.text
    assert theirs.recv(1) == b''  # the connection is closed


def test_disconnected_client_is_no_error(ends, service, caplog):
    ours, theirs = ends
    theirs.sendall(request('robot'))
    theirs.close()
    serve_once(service, ours)
    assert 'Traceback' not in caplog.text
    assert 'Error processing' not in caplog.text


def test_shutdown_waits_for_requests_in_progress(ends, monkeypatch):
    begun, may_end = threading.Event(), threading.Event()

    def handler(request):
        begun.set()
        may_end.wait(60.0)
        return GetModelStateResponse(status_message=request.model_name)

    monkeypatch.setattr(ServiceImpl, '_handle_request', answer)
    ours, theirs = ends
    theirs.sendall(request('box'))
    thread = threading.Thread(
        target=serve_once, args=(ServiceImpl('~get_model_state', GetModelState, handler), ours)
    )
    assert wait_for_answers(0.0)
    thread.start()
    assert begun.wait(60.0)
    assert not wait_for_answers(0.01)
    may_end.set()
    assert wait_for_answers(5.0)
    assert b'box' in theirs.recv(BUFFER)
    thread.join(60.0)
