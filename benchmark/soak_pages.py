"""Visitors of the page for the soak test: they look at sensors, attack and leave without a word.

They run in a process of their own, which connects and disconnects in turn until it is told to rest.
"""

from __future__ import annotations

import contextlib
import random
import socket
from collections.abc import Callable
from multiprocessing.connection import Connection
from urllib.parse import urlsplit

from support.browser import CAMERA, Browser
from websockets.exceptions import ConnectionClosed, InvalidHandshake

UPLOAD = 'Upload URDF, xacro or SDF'
LOST = (ConnectionClosed, InvalidHandshake, OSError)


def visit(address: str, seed: int, orders: Connection) -> None:
    """Visit the page whenever a number comes, so often, and send it back; end at zero."""
    rng = random.Random(seed)
    while times := orders.recv():
        for _ in range(times):
            with contextlib.suppress(*LOST):
                rng.choice(VISITS)(address)
        orders.send(times)


def look(address: str) -> None:
    """Look at all sensors for a moment."""
    with _browser(address) as browser:
        browser.read(0.3)
        boxes = [
            uuid
            for uuid, (kind, props) in browser.controls.items()
            if kind == 'GuiCheckboxMessage' and str(props['label']).startswith('/')
        ]
        for box in boxes:
            browser.send({'type': 'GuiUpdateMessage', 'uuid': box, 'updates': {'value': True}})
        browser.read(0.5)


def leave_at_once(address: str) -> None:
    """Connect and be gone."""
    _browser(address)._connection.socket.close()


def upload_half(address: str) -> None:
    """Begin a large file, and go."""
    with _browser(address) as browser:
        button = browser.control(UPLOAD)
        browser.send(
            {
                'type': 'FileTransferStartUpload',
                'source_component_uuid': button,
                'transfer_uuid': 'half',
                'filename': 'half',
                'mime_type': '',
                'part_count': 20,
                'size_bytes': 9_000_000,
            }
        )
        browser.send(
            {
                'type': 'FileTransferPart',
                'source_component_uuid': button,
                'transfer_uuid': 'half',
                'part_index': 0,
                'content': 500_000 * b'x',
            }
        )


def send_nonsense(address: str) -> None:
    """Send what no page sends, and be disconnected."""
    with _browser(address) as browser:
        browser.send({**CAMERA, 'position': [float('nan')] * 3})
        browser._connection.send(b'\xc1')
        browser.read(0.2)


def knock(address: str) -> None:
    """Ask without the token, and not to the end."""
    url = urlsplit(address)
    with socket.create_connection((url.hostname, url.port)) as stranger:
        stranger.sendall(b'GET / HTTP/1.1\r\nUpgrade: websocket\r\n')


VISITS: tuple[Callable[[str], None], ...] = (look, leave_at_once, upload_half, send_nonsense, knock)


def _browser(address: str) -> Browser:
    browser = Browser(address)
    browser.wait_until(lambda: browser.control(UPLOAD))
    return browser
