"""Access to the page: whoever has its token, as in Jupyter.

The printed address carries the token. It leads to a path that is as hard to guess, and sets a
cookie for that path. Browsers send the cookies of a host to all its ports; by the path, the
server of another user at another port of this machine does not get this one.
"""

import base64
import hashlib
import hmac
import http
import ipaddress
import re
import secrets
import socket
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any
from urllib.parse import parse_qsl, urlencode, urlsplit

from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request, Response

LOOPBACK = ('127.0.0.1', '::1', 'localhost')
TOKEN = re.compile(r'[A-Za-z0-9_-]{16,128}')
NO_TOKEN = 'The address needs the token that gzweb has printed.'
OTHER_PAGE = 'This window is not for other pages.'
OTHER_HOST = 'Without a token, this window has no name but those of its machine.'
MALFORMED = 'The address in this request is malformed.'

Process = Callable[[ServerConnection, Request], Response | None]


def new_token() -> str:
    """Return a random token of 256 bits."""
    return secrets.token_urlsafe(32)


class Door:
    """Decides which requests are let in."""

    def __init__(self, host: str, port: int, token: str, headers: dict[str, str]) -> None:
        """Make the door of a server.

        Args:
            host: the address that is served; port: its port.
            token: what requests need; '' for none.
            headers: of every response.
        """
        self._host, self._token, self._headers = host, token, headers
        self._cookie = f'rosbots_window_{port}'
        digest = hmac.digest(token.encode(), b'path', hashlib.sha256)
        self._path = base64.urlsafe_b64encode(digest)[:22].decode()

    def guarding(self, process: Process) -> Process:
        """Return `process` for those requests only that are let in."""
        def guarded(connection: ServerConnection, request: Request) -> Response | None:
            try:
                response = self._answer(connection, request, process)
            except (ValueError, LookupError):  # of urlsplit; of a header that is there twice
                response = connection.respond(http.HTTPStatus.FORBIDDEN, f'{MALFORMED}\n')
            if response is not None:
                for name, value in self._headers.items():
                    response.headers[name] = value
            return response
        return guarded

    def _answer(self, connection: ServerConnection, request: Request,
                process: Process) -> Response | None:
        reason = self._refusal(request.path, request.headers)
        if reason:
            return connection.respond(http.HTTPStatus.FORBIDDEN, f'{reason}\n')
        if not self._token or request.headers.get('Upgrade', '').lower() == 'websocket':
            return process(connection, request)
        url = urlsplit(request.path)
        if self._is_inside(url.path):
            inner = url.path.removeprefix(f'/{self._path}') or '/'
            response = process(connection, replace(request, path=inner))
        else:
            rest = urlencode([(name, value) for name, value in parse_qsl(url.query, True)
                              if name != 'token'])
            response = connection.respond(http.HTTPStatus.SEE_OTHER, '')
            response.headers['Location'] = f'/{self._path}/' + (f'?{rest}' if rest else '')
        if response is not None and self._knows_token(url.query):
            response.headers['Set-Cookie'] = (
                f'{self._cookie}={self._token}; Path=/{self._path}; HttpOnly; SameSite=Strict')
        return response

    def _refusal(self, path: str, headers: Any) -> str:  # noqa: ANN401  a mapping without its type
        """Return why a request is refused, in a sentence; '' if it is not."""
        host, origin = headers.get('Host', ''), headers.get('Origin', '')
        if origin and urlsplit(origin).netloc != host:
            return OTHER_PAGE
        if not self._token:
            return '' if self._is_own_name(urlsplit(f'//{host}').hostname or '') else OTHER_HOST
        url = urlsplit(path)
        if self._knows_token(url.query):
            return ''
        is_socket = headers.get('Upgrade', '').lower() == 'websocket'
        has_cookie = any(self._is_token(value) for value in self._cookies(headers))
        # The file of the page is no secret; what it connects to is.
        return '' if self._is_inside(url.path) and (has_cookie or not is_socket) else NO_TOKEN

    def _knows_token(self, query: str) -> bool:
        return any(name == 'token' and self._is_token(value) for name, value in parse_qsl(query))

    def _cookies(self, headers: Any) -> Iterator[str]:  # noqa: ANN401
        """Yield the values of this server's cookie; other servers of the host can set others."""
        for header in headers.get_all('Cookie'):
            for part in header.split(';'):
                name, _, value = part.strip().partition('=')
                if name == self._cookie:
                    yield value

    def _is_token(self, text: str) -> bool:
        return hmac.compare_digest(text.encode(errors='replace'), self._token.encode())

    def _is_inside(self, path: str) -> bool:
        first = path.removeprefix('/').partition('/')[0]
        return path.startswith('/') and hmac.compare_digest(
            first.encode(errors='replace'), self._path.encode())

    def _is_own_name(self, name: str) -> bool:
        """Tell whether a name leads here for sure, as one of a foreign domain does not."""
        if name in LOOPBACK:
            return True
        if self._host in LOOPBACK:
            return False
        try:
            ipaddress.ip_address(name)
        except ValueError:
            return name in {self._host, socket.gethostname(), socket.getfqdn()}
        return True
