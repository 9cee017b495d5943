"""The table of services: adding one is one decorated function."""

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import rospy
from genpy import Message

from ...sim.core import SimError
from ..server import Server

logger = logging.getLogger(__name__)

Answer = Callable[[Server, Any], Message]


class CallError(SimError):
    """A request for which Gazebo fails the call itself, instead of returning success=False."""


@dataclass(frozen=True)
class Service:
    """How a service is answered: `prepare` beside the loop, then `answer`."""

    name: str  # without the node's name
    type: type[Any]
    answer: Answer
    prepare: Answer | None = None
    registers: bool = False  # adds or removes topics; the response waits for their registration
    on_loop: bool = True  # whether `answer` runs on the loop's thread or on the caller's


SERVICES: dict[str, Service] = {}  # those of Gazebo
EXTENSIONS: dict[str, Service] = {}  # ours


def service(
    name: str,
    service_type: type[Any],
    prepare: Answer | None = None,
    registers: bool = False,
    on_loop: bool = True,
    table: dict[str, Service] = SERVICES,
) -> Callable[[Answer], Answer]:
    """Return a decorator that makes `answer(server, request) -> response` the service ~`name`.

    The function runs on the thread that owns the world; with `on_loop=False` on the caller's, where
    it may use the world only by `server.loop.call`. Slow work that does not need the world goes
    into `prepare(server, request)`. Its result is passed to `answer` as the request; if it is a
    response, it is sent at once. Either may raise `SimError`, which becomes success=False with its
    message, or `CallError`, which makes the call fail.
    """

    def add(answer: Answer) -> Answer:
        if name in table:
            raise ValueError(f'service {name} is already answered by {table[name].answer}')
        table[name] = Service(name, service_type, answer, prepare, registers, on_loop)
        return answer

    return add


def refuse(response: Message, text: str, level: int = logging.ERROR) -> Message:
    """Return the response with success=False and the text, which is logged as well."""
    logger.log(level, '%s', text)
    response.success, response.status_message = False, text
    return response


def advertise(server: Server, table: Mapping[str, Service]) -> list[rospy.Service]:
    """Advertise the services of a table in the node's private namespace."""
    return [
        rospy.Service(f'~{entry.name}', entry.type, _handler(server, entry))
        for entry in table.values()
    ]


def _handler(server: Server, entry: Service) -> Callable[[Message], Message]:
    def handle(request: Message) -> Message:
        try:
            return respond(server, entry, request)
        except CallError as error:
            raise rospy.ServiceException(str(error)) from None

    return handle


def respond(server: Server, entry: Service, request: Message) -> Message:
    """Return the response to `request`; called on a thread that does not own the world.

    Raises:
        CallError: the call itself fails.

    """
    response_class = entry.type._response_class
    try:
        prepared = request
        if entry.prepare:
            prepared = server.loop.run_in_thread(partial(entry.prepare, server, request))
        if isinstance(prepared, response_class):
            return prepared
        answer = partial(entry.answer, server, prepared)
        response = server.loop.call(answer) if entry.on_loop else answer()
    except CallError:
        raise
    except SimError as error:
        # At the end of the simulator that is no error, but how calls end.
        level = logging.INFO if server.loop.stopping else logging.ERROR
        return _failure(entry, response_class(), str(error), level)
    if entry.registers:
        server.registrar.await_registration(entry.name)
    return response


def _failure(entry: Service, response: Message, sentence: str, level: int) -> Message:
    """Return `response` with success=False and the message, prefixed by the service's type."""
    if hasattr(response, 'success'):
        return refuse(response, f'{entry.type.__name__}: Failure - {sentence}', level)
    # Types without `success`, such as std_srvs/Empty, are shared by several services.
    text = f'{entry.name}: Failure - {sentence}'
    logger.log(level, '%s', text)
    raise CallError(text)
