"""What browsers may make the server do and keep: checked before viser reads it."""

import asyncio
import logging
import time
from collections import deque
from collections.abc import Awaitable, Callable, Iterable
from concurrent.futures import Executor, Future
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import viser
from viser._gui_handles import _GuiInputHandle
from viser._messages import FileTransferPartAck, GuiUpdateMessage
from websockets.asyncio.server import ServerConnection
from websockets.typing import Data

from ..controls import RateLimit, left_out, show_notice
from .access import CONTROLS
from .client_messages import MalformedError, Message, RefusedError, check_value, is_camera, read
from .uploads import Upload, Uploads

logger = logging.getLogger(__name__)

MOST_CLIENTS = 16
FULL = 'This window has no room for another browser.'
LOOKS = 'This address is for looking: its browsers see everything and change nothing.'
# What a browser may send that may only look: where its camera is, what it clicks on, which selects
# that for itself, pictures that it is asked for, and confirmations of parts of a download. Parts of
# uploads are dropped, as none has begun.
OF_VIEWERS = {
    'ViewerCameraMessage',
    'SceneNodeClickMessage',
    'GetRenderResponseMessage',
    'FileTransferPartAck',
    'FileTransferPart',
}
MAX_MESSAGE = 24_000_000  # [bytes], that of a large picture
# Messages that wait for the first one of a camera, and their size [bytes], at most.
MOST_EARLY, MAX_EARLY = 100, 1000
RATE, BURST = 1000.0, 5000.0  # messages of a browser in a second, and at once
BACKLOG = 200  # commands that wait to be carried out; further ones are not read meanwhile
ROOM = 0.02  # [s, wall] between two looks for room
HOPELESS = 10.0  # [s, wall] after which a command is refused for which there is none
BUSY = 'The simulator is busy: some of what was done here is left out'
PAUSE = 1.0  # [s, wall] between two notices of refusals

Received = Callable[[viser.ClientHandle, str, bytes], object]
Handler = Callable[[ServerConnection], Awaitable[None]]
Control = viser.GuiInputHandle[Any] | viser.GuiButtonHandle | viser.CommandHandle


@dataclass
class Visitor:
    """A connection, and what is known of it."""

    connection: ServerConnection
    may_control: bool
    has_looked: bool = False  # its first camera message has come
    early: deque[Data] = field(default_factory=deque)  # what came before
    messages: RateLimit = field(default_factory=lambda: RateLimit(BURST, RATE))
    next_notice: float = 0.0  # [s, monotonic]
    left_out: int = 0  # notices since the last one


class MessageGate:
    """Reads the messages of all connections; on the server's own thread."""

    def __init__(self, site: viser.ViserServer, most_clients: int = MOST_CLIENTS) -> None:
        """Begin closed; there is room for so many browsers that control, and as many that look."""
        self._site, self._most_clients = site, most_clients
        self.is_open = False  # not before the site is complete
        # By the numbers of controls: the interface that has each, of a browser or of all.
        self._for_viewers: dict[str, viser.GuiApi] = {}
        self._visitors: dict[int, Visitor] = {}  # by the identity of the connection
        self._uploads = Uploads()
        self._receivers: dict[str, tuple[viser.GuiApi, Received]] = {}  # of files, likewise

    def receive(self, button: viser.GuiUploadButtonHandle, received: Received) -> None:
        """Call back, on a thread, with browser, name and content of each file of a button."""
        self._receivers[button._impl.uuid] = button._impl.gui_api, received

    def allow_viewers(self, controls: Iterable[Control]) -> None:
        """Let browsers that may only look use controls that act on their own browser only."""
        self._for_viewers |= {one._impl.uuid: one._impl.gui_api for one in controls}

    def may_control(self, client: viser.ClientHandle) -> bool:
        """Tell whether a browser may do more than look."""
        return any(
            visitor.may_control and self._client(visitor) is client
            for visitor in tuple(self._visitors.values())
        )

    def greet(self, client: viser.ClientHandle) -> None:
        """Tell a browser that may only look so."""
        if not self.may_control(client):
            show_notice(client, LOOKS)

    def forget(self, client: viser.ClientHandle) -> None:
        """Forget the controls that only a browser had which has disconnected."""
        gui = client.gui
        self._for_viewers = {n: own for n, own in self._for_viewers.items() if own is not gui}
        self._receivers = {n: one for n, one in self._receivers.items() if one[0] is not gui}

    def connection_class(self) -> type[ServerConnection]:
        """Return the class of connections whose messages are checked here."""
        gate = self

        class Connection(ServerConnection):
            async def recv(  # type: ignore[override]  # of its overloads, viser uses none
                self, decode: bool | None = None
            ) -> Data:
                while True:
                    raw = await gate._next(self, partial(super().recv, decode))
                    if await gate._admits(self, raw):
                        return raw

        return Connection

    def counting(self, handler: Handler) -> Handler:
        """Return the handler of a connection with a limit on how many there are."""

        async def counted(connection: ServerConnection) -> None:
            may_control = getattr(connection, CONTROLS, False)
            alike = [one for one in self._visitors.values() if one.may_control == may_control]
            if not self.is_open or len(alike) >= self._most_clients:
                await connection.close(1013, FULL)
                return
            visitor = self._visitors[id(connection)] = Visitor(connection, may_control)
            try:
                await handler(connection)
            finally:
                del self._visitors[id(connection)]
                self._uploads.leave(visitor)

        return counted

    async def _next(
        self, connection: ServerConnection, receive: Callable[[], Awaitable[Data]]
    ) -> Data:
        """Return the next message.

        What is done before the page has said where it looks comes after that: a slow page shows
        its buttons before the scene, and viser drops what is not from a client it knows.
        """
        visitor = self._visitors[id(connection)]
        while not visitor.has_looked:
            raw = await receive()
            visitor.has_looked = is_camera(raw)
            is_kept = len(visitor.early) < MOST_EARLY and len(raw) <= MAX_EARLY
            if visitor.has_looked or not is_kept:
                return raw
            visitor.early.append(raw)
        if self._client(visitor) is None:
            await asyncio.sleep(0)  # viser has yet to take in the first camera message
        return visitor.early.popleft() if visitor.early else await receive()

    async def _admits(self, connection: ServerConnection, raw: object) -> bool:
        """Return whether viser is to read a message; a malformed one ends its connection."""
        visitor = self._visitors[id(connection)]
        delay = visitor.messages.take()
        if delay > 0.0:
            await asyncio.sleep(delay)
        try:
            await self._wait_for_room()
            message = read(raw)
            if not visitor.may_control:
                self._check_viewer(visitor, message)
            return self._check(visitor, message)
        except RefusedError as error:
            self._notify(visitor, str(error))
        except MalformedError as error:
            logger.warning('a browser is disconnected: %s', error)
            await connection.close(1008, str(error)[:100])
        return False

    async def _wait_for_room(self) -> None:
        """Wait until few commands wait, so that one browser's flood costs no other a command."""
        executor: Any = self._site._thread_executor  # viser's
        end = time.monotonic() + HOPELESS
        while executor._work_queue.qsize() > BACKLOG:
            if time.monotonic() > end:
                raise RefusedError(BUSY)
            await asyncio.sleep(ROOM)

    def _check(self, visitor: Visitor, message: Message) -> bool:
        kind = type(message).__name__
        if kind == 'FileTransferStartUpload':
            self._start(visitor, message)
            return False
        if kind == 'FileTransferPart':
            self._add(visitor, message)
            return False
        if kind in {'FileTransferPartAck', 'GetRenderResponseMessage'}:
            return True
        if kind == 'GuiUpdateMessage':
            control = self._control(visitor, message.uuid)
            if control is not None:
                check_value(control, message.updates['value'])
        return True

    def _check_viewer(self, visitor: Visitor, message: Message) -> None:
        """Refuse what changes anything but view and selection of a browser that may only look.

        Raises:
            RefusedError: it does.
        """
        if type(message).__name__ in OF_VIEWERS or (
            getattr(message, 'uuid', None) in self._for_viewers
        ):
            return
        self._undo(visitor, message)
        raise RefusedError(LOOKS)

    def _undo(self, visitor: Visitor, message: Message) -> None:
        """Show a browser again what is true, in place of what was done there."""
        client = self._client(visitor)
        kind = type(message).__name__
        if client is None:
            return
        if kind == 'GuiUpdateMessage':
            control = self._control(visitor, message.uuid)
            if control is not None:
                client._websock_connection.queue_message(
                    GuiUpdateMessage(message.uuid, {'value': control.value})
                )
        elif kind == 'FileTransferStartUpload':
            self._acknowledge(visitor, message, message.size_bytes)  # ends it in the browser

    def _control(self, visitor: Visitor, number: str) -> _GuiInputHandle[Any] | None:
        """Return a control of this browser, or of all; None: it has none of that number."""
        client = self._client(visitor)
        own = {} if client is None else client.gui._gui_input_handle_from_uuid
        return own.get(number) or self._site.gui._gui_input_handle_from_uuid.get(number)

    def _start(self, visitor: Visitor, message: Message) -> None:
        button = message.source_component_uuid
        if button not in self._receivers or self._control(visitor, button) is None:
            raise MalformedError('This is no button for files.')
        try:
            upload = self._uploads.start(visitor, message)
        except RefusedError:
            self._acknowledge(visitor, message, message.size_bytes)  # ends it in the browser
            raise
        if upload.is_whole:
            self._acknowledge(visitor, message, 0)
            self._hand_over(visitor, upload)

    def _add(self, visitor: Visitor, message: Message) -> None:
        try:
            upload = self._uploads.add(visitor, message)
        except RefusedError:
            self._acknowledge(visitor, message, 0)
            raise
        if upload is not None:
            self._acknowledge(visitor, message, upload.size, upload.received)
            if upload.is_whole:
                self._hand_over(visitor, upload)

    def _acknowledge(
        self, visitor: Visitor, message: Message, size: int, received: int | None = None
    ) -> None:
        """Let a browser show how much of its file has come; by default, all of it."""
        client = self._client(visitor)
        if client is not None:
            client._websock_connection.queue_message(
                FileTransferPartAck(
                    message.source_component_uuid,
                    message.transfer_uuid,
                    size if received is None else received,
                    size,
                )
            )

    def _hand_over(self, visitor: Visitor, upload: Upload) -> None:
        client = self._client(visitor)
        if client is not None:
            executor: Executor = self._site._thread_executor
            _, received = self._receivers[upload.button]
            done = executor.submit(received, client, upload.name, upload.content)
            done.add_done_callback(_log_failure)

    def _notify(self, visitor: Visitor, sentence: str) -> None:
        """Tell a browser what is refused; of many at once the first, and how many others."""
        now = time.monotonic()
        if now >= visitor.next_notice:
            self._show(visitor, sentence)
        else:
            if not visitor.left_out:
                asyncio.get_running_loop().call_later(
                    visitor.next_notice - now, self._tell_left_out, visitor
                )
            visitor.left_out += 1

    def _tell_left_out(self, visitor: Visitor) -> None:
        count, visitor.left_out = visitor.left_out, 0
        self._show(visitor, left_out(count))

    def _show(self, visitor: Visitor, sentence: str) -> None:
        visitor.next_notice = time.monotonic() + PAUSE
        client = self._client(visitor)
        if client is not None:
            show_notice(client, sentence)

    def _client(self, visitor: Visitor) -> viser.ClientHandle | None:
        """Return viser's handle of a connection; None before its first camera message."""
        connections = self._site._websock_server._live_connections
        return next(
            (
                self._site.get_clients().get(number)
                for number, one in tuple(connections.items())
                if one is visitor.connection
            ),
            None,
        )


def _log_failure(done: Future[Any]) -> None:
    error = done.exception()
    if error is not None:
        logger.error('an uploaded file is not used', exc_info=error)
