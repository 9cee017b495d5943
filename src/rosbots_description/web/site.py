"""Where the page is served, and to whom.

Viser serves whoever reaches its port. Here its port is on this machine only, unless another address
is asked for: then requests need a token. Pages of other sites that are open in the same browser are
refused.
"""

import hmac
import http
import secrets
import socket
import warnings
from collections.abc import Callable
from http.cookies import CookieError, SimpleCookie
from typing import Any
from unittest import mock
from urllib.parse import parse_qs, urlsplit

import rich
import viser
import websockets.asyncio.server
from viser._messages import FileTransferPart, FileTransferPartAck, FileTransferStartUpload
from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request, Response

LOOPBACK = ('127.0.0.1', '::1', 'localhost')
Process = Callable[[ServerConnection, Request], Response | None]


class WindowError(Exception):
    """The window cannot be opened; the message is one sentence."""


class Site(viser.ViserServer):
    """Viser's server on a socket of our own, with a guarded door."""

    def __init__(self, host: str, port: int, token: str = '') -> None:
        """Begin to serve.

        Args:
            host: address or name of the interface; port: 0 for any that is free.
            token: what requests need; '' for a new one, unless only this machine is served.
        Raises:
            WindowError: the address is not this machine's, or the port is in use.
        """
        listener = _listen(host, port)
        port = listener.getsockname()[1]
        self.token = '' if host in LOOPBACK else token or secrets.token_urlsafe(16)
        shown = f'[{host}]' if ':' in host else host
        if host in {'0.0.0.0', '::'}:
            shown = socket.gethostname()
        self.address = f'http://{shown}:{port}/' + (f'?token={self.token}' if self.token else '')
        door = Door(port, self.token)
        serve = websockets.asyncio.server.serve

        def serve_here(handler: Any, *_address: Any, process_request: Process,  # noqa: ANN401
                       **options: Any) -> Any:  # noqa: ANN401
            return serve(handler, sock=listener, process_request=door.guarding(process_request),
                         **options)

        rich.reconfigure(quiet=True)  # viser's own lines
        # Somebody has left, which is no fault.
        warnings.filterwarnings('ignore', r'Queued a \w+ on a closed connection')
        # Viser looks for a free port by itself and takes no socket and no guard.
        with mock.patch('websockets.asyncio.server.serve', serve_here):
            super().__init__(host, port, verbose=False)

    @property
    def is_local(self) -> bool:
        """Tell whether only this machine is served."""
        return not self.token

    def limit_uploads(self, most: int, refused: Callable[[str], None]) -> None:
        """Drop files of more than so many bytes before they fill the memory; viser takes any.

        Args:
            refused: called with the name of the file; it must not wait.
        """
        states = self.gui._current_file_upload_states  # viser's, of files that are on their way

        def drop(message: FileTransferStartUpload | FileTransferPart) -> None:
            state = states.pop(message.transfer_uuid)
            size = state['total_bytes']
            self._websock_server.queue_message(FileTransferPartAck(  # that ends it in the browser
                message.source_component_uuid, message.transfer_uuid, size, size))
            refused(state['filename'])

        def start(_client: int, message: FileTransferStartUpload) -> None:
            if message.transfer_uuid in states and message.size_bytes > most:
                drop(message)

        def go_on(_client: int, message: FileTransferPart) -> None:
            state = states.get(message.transfer_uuid)
            if state is not None and state['transferred_bytes'] > most:
                drop(message)

        self._websock_server.register_handler(FileTransferStartUpload, start)
        self._websock_server.register_handler(FileTransferPart, go_on)

    def request_share_url(self, verbose: bool = True) -> str | None:
        """Refuse to publish this page through viser's servers."""
        return None


class Door:
    """Tells which requests are let in."""

    def __init__(self, port: int, token: str) -> None:
        self._token = token
        self._cookie = f'rosbots_window_{port}'  # a browser's cookies are for all ports of a host

    def guarding(self, process: Process) -> Process:
        """Return `process` for those requests only that are let in."""
        def guarded(connection: ServerConnection, request: Request) -> Response | None:
            try:
                reason = self.refusal(request.path, request.headers)
            except ValueError:  # of urlsplit
                reason = 'The address in this request is malformed.'
            if reason:
                return connection.respond(http.HTTPStatus.FORBIDDEN, reason + '\n')
            response = process(connection, request)
            if response is not None and self._token:
                # The page connects without the token in its address.
                response.headers['Set-Cookie'] = (
                    f'{self._cookie}={self._token}; HttpOnly; SameSite=Strict')
                response.headers['Referrer-Policy'] = 'no-referrer'
            return response
        return guarded

    def refusal(self, path: str, headers: Any) -> str:  # noqa: ANN401  a mapping without its type
        """Return why a request is refused, in a sentence; '' if it is not."""
        host, origin = headers.get('Host', ''), headers.get('Origin', '')
        if origin and urlsplit(origin).netloc != host:
            return 'This window is not for other pages.'
        if not self._token:
            local = urlsplit(f'//{host}').hostname in LOOPBACK
            return '' if local else 'This window is for this machine only; web_host opens it.'
        if self._knows_token(path, headers.get('Cookie', '')):
            return ''
        return 'The address needs the token that gzweb has printed.'

    def _knows_token(self, path: str, cookies: str) -> bool:
        try:
            kept = SimpleCookie(cookies).get(self._cookie)
        except CookieError:
            kept = None
        told = parse_qs(urlsplit(path).query).get('token', [])
        return any(hmac.compare_digest(one.encode(), self._token.encode())
                   for one in (*told, *((kept.value,) if kept else ())))


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
        raise WindowError(f'no window at {host}, port {port}: {reason}; '
                          'web_port and web_host choose others') from error
