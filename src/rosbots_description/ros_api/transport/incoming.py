"""Handles oversized messages, malformed requests and lost clients, which rospy does not."""

import contextlib
import logging
import socket
import struct
import threading
from contextvars import ContextVar
from io import BytesIO

from genpy import DeserializationError, Message
from rospy.exceptions import TransportException, TransportTerminated
from rospy.impl import tcpros_base
from rospy.impl.tcpros_base import TCPROSTransport, recv_buff
from rospy.impl.tcpros_service import ServiceImpl

from .delivery import await_data

logger = logging.getLogger(__name__)

# [bytes] rospy buffers a whole message in memory and accepts any length. The limit is far above any
# description, so that too long ones are still received and rejected with a message.
MAX_MESSAGE_SIZE = 1 << 28
_LENGTH = struct.Struct('<I')  # length prefix [bytes]
_handle, _complain = ServiceImpl.handle, ServiceImpl.error_handler
_answer = ServiceImpl._handle_request
_answering: set[int] = set()  # threads with a request in progress
_answered = threading.Condition()
# The connection of the current request.
_connection: ContextVar[socket.socket | None] = ContextVar('connection', default=None)


def guard_messages() -> None:
    """Install these checks for all connections of this process; call once before `init_node`.

    rospy has no public API for this.
    """
    tcpros_base.recv_buff = receive
    ServiceImpl.handle = serve
    ServiceImpl.error_handler = complain
    ServiceImpl._handle_request = answer


def receive(connection: socket.socket, buffer: BytesIO, size: int) -> int:
    """Receive as rospy does into a buffer that starts with a message; return the byte count.

    Raises:
        TransportTerminated: the connection is closed, or the message is too long.
    """
    await_data(connection)
    count: int = recv_buff(connection, buffer, size)
    if buffer.tell() >= _LENGTH.size:
        with buffer.getbuffer() as content:
            (length,) = _LENGTH.unpack_from(content)
        if length > MAX_MESSAGE_SIZE:
            sentence = f'a message of {length} bytes is rejected; the limit is {MAX_MESSAGE_SIZE}'
            logger.warning('%s', sentence)
            raise TransportTerminated(sentence)
    return count


def serve(service: ServiceImpl, transport: TCPROSTransport, header: dict[str, str]) -> None:
    """Answer as rospy does, malformed requests too, and close the connection."""
    try:
        _handle(service, transport, header)
    except (ConnectionError, TransportException) as error:
        if not isinstance(error.__context__, DeserializationError):
            logger.debug('%s: nobody takes the answer: %s', service.resolved_name, error)
            return
        sentence = f'the request does not fit {service.service_class._type}: {error}'
        logger.warning('%s: %s', service.resolved_name, sentence)
        with contextlib.suppress(OSError, TransportException):  # the caller may have disconnected
            service._write_service_error(transport, sentence)
    finally:
        transport.close()


def answer(service: ServiceImpl, transport: TCPROSTransport, request: Message) -> None:
    """Answer a request as rospy does, tracked for `wait_for_answers`."""
    me = threading.get_ident()
    with _answered:
        _answering.add(me)
    _connection.set(transport.socket)
    try:
        _answer(service, transport, request)
    finally:
        with _answered:
            _answering.discard(me)
            _answered.notify_all()


def caller_waits() -> bool:
    """Tell whether the caller of this thread's request still waits for the answer."""
    connection = _connection.get()
    try:
        return not connection or bool(connection.recv(1, socket.MSG_PEEK | socket.MSG_DONTWAIT))
    except BlockingIOError:
        return True
    except OSError:
        return False


def wait_for_answers(timeout: float) -> bool:
    """Wait until all requests are answered; tell whether they were within `timeout` [s]."""
    with _answered:
        return _answered.wait_for(lambda: not _answering, timeout)


def complain(service: ServiceImpl, error: Exception, *details: object) -> None:
    """Log an error of an answer, at debug level if the caller has disconnected."""
    if isinstance(error, (ConnectionError, TransportException)):
        logger.debug('%s: nobody takes the answer: %s', service.resolved_name, error)
    else:
        _complain(service, error, *details)
