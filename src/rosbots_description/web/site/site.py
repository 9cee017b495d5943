"""Where the page is served: viser's server, behind a check of tokens and a gate for messages."""

import logging
import socket
import warnings
from collections.abc import Callable
from typing import Any
from unittest import mock

import rich
import viser
import websockets.asyncio.server
from viser.infra import WebsockClientConnection

from .access import TOKEN, Access, Process, new_token
from .loop_event import leave_to_loop
from .message_gate import MAX_MESSAGE, MOST_CLIENTS, Control, Handler, MessageGate, Received
from .policy import page_headers


class WindowError(Exception):
    """The window cannot be opened; the message is one sentence."""


class Site(viser.ViserServer):
    """Viser's server for those who have the token."""

    def __init__(
        self,
        host: str,
        port: int,
        token: str = '',
        *,
        viewing_token: str = '',
        is_open: bool = False,
        is_framed: bool = False,
        most_viewers: int = MOST_CLIENTS,
    ) -> None:
        """Begin to serve.

        Args:
            host: address or name of the interface; port: 0 for any that is free.
            token: what requests need, 16 to 128 letters, digits, - and _; '' for a new one.
            viewing_token: what lets a browser in that may only look; '' for a new one.
            is_open: let in everybody who reaches the port; there are no tokens then.
            is_framed: pages of this machine, such as notebooks, may show it in a frame.
            most_viewers: browsers at once, by each of the two tokens.
        Raises:
            WindowError: the address is not this machine's, the port is in use, or the token is
                not one.
        """
        for given in filter(None, (token, viewing_token)):
            if not TOKEN.fullmatch(given):
                raise WindowError('the token is not one: it has 16 to 128 letters, digits, - and _')
        if token and token == viewing_token:
            raise WindowError('the token for viewing is that for control; give it another one')
        listener = _listen(host, port)
        port = listener.getsockname()[1]
        self.token = '' if is_open else token or new_token()
        self.viewing_token = '' if is_open else viewing_token or new_token()
        shown = f'[{host}]' if ':' in host else host
        if host in {'0.0.0.0', '::'}:
            shown = socket.gethostname()
        place = f'http://{shown}:{port}/'
        self.address = place + (f'?token={self.token}' if self.token else '')
        self.viewing_address = f'{place}?token={self.viewing_token}' if self.viewing_token else ''
        self._gate = gate = MessageGate(self, most_viewers)
        access = Access(host, port, self.token, self.viewing_token, page_headers(is_framed))
        rich.reconfigure(quiet=True)  # viser's own lines
        logging.getLogger('websockets.server').addFilter(_is_kept)
        # Somebody has left, which is no fault.
        warnings.filterwarnings('ignore', r'Queued a \w+ on a closed connection')
        # Viser looks for a free port by itself and takes no socket and no guard.
        with mock.patch('websockets.asyncio.server.serve', _serving(listener, access, gate)):
            super().__init__(host, port, verbose=False)
        leave_to_loop(self._websock_server.get_message_buffer())
        self._websock_server.on_client_connect(self._prepare)
        gate.is_open = True
        self.on_client_connect(gate.greet)

    def _prepare(self, connection: WebsockClientConnection) -> None:
        leave_to_loop(connection.get_message_buffer())
        # A recording takes messages to all and to one browser: one at a time.
        connection._record_lock = self._websock_server._record_lock

    def receive_files(self, button: viser.GuiUploadButtonHandle, received: Received) -> None:
        """Call back, on a thread, with browser, name and content of each file of a button."""
        self._gate.receive(button, received)

    def allow_viewers(self, *controls: Control) -> None:
        """Let browsers that may only look use controls that act on their own browser only."""
        self._gate.allow_viewers(controls)

    def forget(self, client: viser.ClientHandle) -> None:
        """Forget the controls that only a browser had which has disconnected."""
        self._gate.forget(client)

    def may_control(self, client: viser.ClientHandle) -> bool:
        """Tell whether a browser may do more than look."""
        return self._gate.may_control(client)

    def request_share_url(self, verbose: bool = True) -> str | None:
        """Refuse to publish this page through viser's servers."""
        return None


def _is_kept(record: logging.LogRecord) -> bool:
    """Keep what is wrong with open connections, and drop what strangers could fill the log with."""
    return 'handshake' not in record.getMessage() and 'rejected' not in record.getMessage()


def _serving(listener: socket.socket, access: Access, gate: MessageGate) -> Callable[..., object]:
    """Return what viser is to call to serve: on our socket, for those with access."""
    serve = websockets.asyncio.server.serve

    def serve_here(
        handler: Handler, *_address: object, process_request: Process, **options: Any
    ) -> websockets.asyncio.server.serve:
        options |= {
            'sock': listener,
            'process_request': access.guarding(process_request),
            'create_connection': gate.connection_class(),
            'max_size': MAX_MESSAGE,
            'max_queue': 1,
            'server_header': None,
        }
        return serve(gate.counting(handler), **options)

    return serve_here


def _listen(host: str, port: int) -> socket.socket:
    made = None
    try:
        if not 0 <= port < 65536:
            raise ValueError('a port is a number from 0 to 65535')
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)
        family, _, _, _, address = found[0]
        made = socket.socket(family, socket.SOCK_STREAM)
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        made.bind(address)
        made.listen()
        return made
    except (OSError, ValueError) as error:  # ValueError: also a name that is none
        if made is not None:
            made.close()
        reason = getattr(error, 'strerror', None) or error
        raise WindowError(
            f'no window at {host}, port {port}: {reason}; web_port and web_host choose others'
        ) from error
