"""Access to the page: whoever has its token, as in Jupyter.

The printed address carries the token. It leads to a path that is as hard to guess, and sets a
cookie for that path. Browsers send the cookies of a host to all its ports; by the path, the
server of another user at another port of this machine does not get this one. A second token lets
browsers in that may look only.
"""

import base64
import hashlib
import hmac
import http
import ipaddress
import re
import secrets
import socket
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from urllib.parse import parse_qsl, urlencode, urlsplit

from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

LOOPBACK = ('127.0.0.1', '::1', 'localhost')
TOKEN = re.compile(r'[A-Za-z0-9_-]{16,128}')
NO_TOKEN = 'The address needs the token: open the whole address that was printed.'
OTHER_PAGE = 'This window is not for other pages.'
OTHER_HOST = 'Without a token, this window has no name but those of its machine.'
MALFORMED = 'The address in this request is malformed.'

CONTROLS = 'may_control'  # of connections that may

Process = Callable[[ServerConnection, Request], Response | None]


def new_token() -> str:
    """Return a random token of 256 bits."""
    return secrets.token_urlsafe(32)


@dataclass(frozen=True)
class Pass:
    """A token, the path that its address leads to, and the cookie for that path."""

    token: str
    may_control: bool
    cookie: str

    @cached_property
    def path(self) -> str:
        """Return the first part of the path, without slashes."""
        digest = hmac.digest(self.token.encode(), b'path', hashlib.sha256)
        return base64.urlsafe_b64encode(digest)[:22].decode()

    def is_token(self, text: str) -> bool:
        """Tell whether a text is the token."""
        return hmac.compare_digest(text.encode(errors='replace'), self.token.encode())

    def is_inside(self, path: str) -> bool:
        """Tell whether a path begins with that of this pass."""
        first = path.removeprefix('/').partition('/')[0]
        return path.startswith('/') and hmac.compare_digest(
            first.encode(errors='replace'), self.path.encode()
        )


class Access:
    """Decides which requests are let in, and which of the connections may control."""

    def __init__(
        self, host: str, port: int, token: str, viewing_token: str, headers: dict[str, str]
    ) -> None:
        """Make the access to a server.

        Args:
            host: the address that is served; port: its port.
            token: what requests need to control; '' for none.
            viewing_token: what requests need to look only; '' for none.
            headers: of every response.
        """
        self._host, self._headers = host, headers
        control = Pass(token, True, f'rosbots_window_{port}')
        viewing = Pass(viewing_token, False, f'rosbots_viewing_{port}')
        self._passes = [one for one in (control, viewing) if one.token]

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

    def _answer(
        self, connection: ServerConnection, request: Request, process: Process
    ) -> Response | None:
        reason = self._refusal(request.headers)
        if reason:
            return connection.respond(http.HTTPStatus.FORBIDDEN, f'{reason}\n')
        if not self._passes:
            return self._process(connection, request, process, may_control=True)
        url = urlsplit(request.path)
        shown = next((one for one in self._passes if _has_token(one, url.query)), None)
        inside = next((one for one in self._passes if one.is_inside(url.path)), None)
        if request.headers.get('Upgrade', '').lower() == 'websocket':
            if shown is None and inside is not None and self._has_cookie(inside, request.headers):
                shown = inside
            if shown is None:
                return connection.respond(http.HTTPStatus.FORBIDDEN, f'{NO_TOKEN}\n')
            return self._process(connection, request, process, may_control=shown.may_control)
        # The file of the page is no secret; what it connects to is.
        if inside is not None:
            inner = url.path.removeprefix(f'/{inside.path}') or '/'
            response = process(connection, replace(request, path=inner))
        elif shown is not None:
            rest = urlencode(
                [(name, value) for name, value in parse_qsl(url.query, True) if name != 'token']
            )
            response = connection.respond(http.HTTPStatus.SEE_OTHER, '')
            response.headers['Location'] = f'/{shown.path}/' + (f'?{rest}' if rest else '')
        else:
            return connection.respond(http.HTTPStatus.FORBIDDEN, f'{NO_TOKEN}\n')
        if response is not None and shown is not None:
            response.headers['Set-Cookie'] = (
                f'{shown.cookie}={shown.token}; Path=/{shown.path}; HttpOnly; SameSite=Strict'
            )
        return response

    @staticmethod
    def _process(
        connection: ServerConnection, request: Request, process: Process, *, may_control: bool
    ) -> Response | None:
        """Let a request in; a connection that is not told otherwise may only look."""
        if may_control:
            setattr(connection, CONTROLS, True)
        return process(connection, request)

    def _refusal(self, headers: Headers) -> str:
        """Return why a request is refused whatever its token, in a sentence; '' if it is not."""
        host, origin = headers.get('Host', ''), headers.get('Origin', '')
        if origin and urlsplit(origin).netloc != host:
            return OTHER_PAGE
        if not self._passes and not self._is_own_name(urlsplit(f'//{host}').hostname or ''):
            return OTHER_HOST
        return ''

    @staticmethod
    def _has_cookie(one: Pass, headers: Headers) -> bool:
        """Tell whether a cookie has the token; other servers of the host can set others."""
        for header in headers.get_all('Cookie'):
            for part in header.split(';'):
                name, _, value = part.strip().partition('=')
                if name == one.cookie and one.is_token(value):
                    return True
        return False

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


def _has_token(one: Pass, query: str) -> bool:
    return any(name == 'token' and one.is_token(value) for name, value in parse_qsl(query))
