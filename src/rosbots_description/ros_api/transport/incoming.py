"""What rospy does not expect on a connection: endless messages, broken requests, lost clients."""

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

logger = logging.getLogger(__name__)

# [bytes] rospy keeps a message in memory until all of it is there, and believes any length. Texts
# far longer than any description have to come through, to be refused with a sentence.
LONGEST_MESSAGE = 1 << 28
_LENGTH = struct.Struct('<I')  # what a message begins with: how many bytes follow
_handle, _complain = ServiceImpl.handle, ServiceImpl.error_handler
_answer = ServiceImpl._handle_request
_answering: set[int] = set()  # threads that are about to answer a request
_answered = threading.Condition()
# The connection that the request in hand came by.
_connection: ContextVar[socket.socket | None] = ContextVar('connection', default=None)


def guard_messages() -> None:
    """Let all connections of this process keep the bounds; call once before `init_node`.

    rospy has no public place for this.
    """
    tcpros_base.recv_buff = receive
    ServiceImpl.handle = serve
    ServiceImpl.error_handler = complain
    ServiceImpl._handle_request = answer


def receive(connection: socket.socket, buffer: BytesIO, size: int) -> int:
    """Receive as rospy does into a buffer that begins with a message; return how many bytes.

    Raises:
        TransportTerminated: the connection is closed, or the message is too long.
    """
    count = recv_buff(connection, buffer, size)
    if buffer.tell() >= _LENGTH.size:
        with buffer.getbuffer() as content:
            (length,) = _LENGTH.unpack_from(content)
        if length > LONGEST_MESSAGE:
            sentence = f'a message of {length} bytes is rejected; the limit is {LONGEST_MESSAGE}'
            logger.warning('%s', sentence)
            raise TransportTerminated(sentence)
    return count


def serve(service: ServiceImpl, transport: TCPROSTransport, header: dict[str, str]) -> None:
    """Answer as rospy does, also a request that cannot be read, and let go of the connection."""
    try:
        _handle(service, transport, header)
    except (ConnectionError, TransportException) as error:
        if not isinstance(error.__context__, DeserializationError):
            logger.debug('%s: nobody takes the answer: %s', service.resolved_name, error)
            return
        sentence = f'the request does not fit {service.service_class._type}: {error}'
        logger.warning('%s: %s', service.resolved_name, sentence)
        with contextlib.suppress(OSError, TransportException):  # who asked may have gone
            service._write_service_error(transport, sentence)
    finally:
        transport.close()


def answer(service: ServiceImpl, transport: TCPROSTransport, request: Message) -> None:
    """Answer a request as rospy does; `wait_for_answers` knows of it meanwhile."""
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
    """Tell whether who asked for what this thread works on still waits for the answer."""
    connection = _connection.get()
    try:
        return not connection or bool(
            connection.recv(1, socket.MSG_PEEK | socket.MSG_DONTWAIT))
    except BlockingIOError:
        return True
    except OSError:
        return False


def wait_for_answers(patience: float) -> bool:
    """Wait until no request is without its answer; tell whether that was within `patience` [s]."""
    with _answered:
        return _answered.wait_for(lambda: not _answering, patience)


def complain(service: ServiceImpl, error: Exception, *details: object) -> None:
    """Log a fault in an answer, unless it is that who asked has not waited for it."""
    if isinstance(error, (ConnectionError, TransportException)):
        logger.debug('%s: nobody takes the answer: %s', service.resolved_name, error)
    else:
        _complain(service, error, *details)
