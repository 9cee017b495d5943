"""The content security policy of the page: its own scripts run, and no others.

Viser's client is one file. Its first script unpacks a second one from an attribute, and the page
has handlers of its own (`camera_keys`, `layout`, `world_name`); each is allowed by its hash. What
a browser would take for markup of a stranger could run nothing and load nothing. These scripts may
evaluate text, as one of viser's modules of WebAssembly does; that runs nothing that comes as
markup.
"""

import base64
import hashlib
import html
import re
from functools import cache
from pathlib import Path

import viser
import zstandard

from ..controls import HANDLERS, LAY_OUT, SET_TITLE

_NOTEBOOKS = 'http://127.0.0.1:* http://localhost:* vscode-webview:'
_SCRIPT = re.compile(r'<script\b([^>]*)>(.*?)</script>', re.DOTALL)
_ATTRIBUTE = re.compile(r'\bdata-(p|ss|cs)="([^"]*)"')
# All printable characters that need no escape in an attribute; four bytes are five of them.
_ALPHABET = bytes(code for code in range(0x21, 0x7F) if code not in b'"&<>\'`')


def page_headers(is_framed: bool = False) -> dict[str, str]:
    """Return the headers of every response; pages of this machine may frame it, if it says so."""
    scripts = ' '.join(
        _hash(script) for script in (*_client_scripts(), *HANDLERS, *LAY_OUT, SET_TITLE)
    )
    policy = {
        'default-src': "'none'",
        'script-src': f"'unsafe-hashes' 'unsafe-eval' {scripts}",
        'style-src': "'unsafe-inline'",
        'img-src': 'data: blob:',
        'font-src': 'data:',
        'media-src': 'data: blob:',
        'worker-src': 'data: blob:',
        'connect-src': "'self' data: blob:",  # 'self' has the WebSocket, too
        'base-uri': "'none'",
        'form-action': "'none'",
        'frame-ancestors': _NOTEBOOKS if is_framed else "'none'",
    }
    return {
        'Content-Security-Policy': '; '.join(f'{name} {value}' for name, value in policy.items()),
        **({} if is_framed else {'X-Frame-Options': 'DENY'}),
        'X-Content-Type-Options': 'nosniff',
        'Referrer-Policy': 'no-referrer',
        'Cache-Control': 'no-store',
        'Cross-Origin-Opener-Policy': 'same-origin',
        'Cross-Origin-Resource-Policy': 'same-origin',
    }


@cache
def _client_scripts() -> tuple[str, ...]:
    """Return the scripts of viser's client, those that it unpacks included."""
    page = Path(viser.__file__).with_name('client').joinpath('build/index.html').read_text('utf-8')
    found = []
    for attributes, script in _SCRIPT.findall(page):
        found.append(script)
        packed = {name: html.unescape(value) for name, value in _ATTRIBUTE.findall(attributes)}
        if packed:
            styles, size = int(packed['ss']), int(packed['cs'])
            content = zstandard.ZstdDecompressor().decompress(
                _decoded(packed['p'].encode()), max_output_size=styles + size
            )
            found.append(content[styles : styles + size].decode('utf-8'))
    return tuple(found)


def _decoded(text: bytes) -> bytes:
    """Return the bytes that a text in base 88 stands for."""
    digit = {code: number for number, code in enumerate(_ALPHABET)}
    made = bytearray()
    for start in range(0, len(text), 5):
        group = text[start : start + 5]
        value = 0
        for code in group:
            value = value * len(_ALPHABET) + digit[code]
        made += value.to_bytes(len(group) - 1, 'big')
    return bytes(made)


def _hash(script: str) -> str:
    digest = hashlib.sha256(script.encode('utf-8')).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"
