"""Sentences to those who look at the page."""

import threading
from collections.abc import Callable, Iterable

import viser

from .panel import Panel
from .rate_limit import RateLimit
from .text import plain

MOST = 1000  # characters of a notice
AT_ONCE, RATE = 20.0, 2.0  # notices at once, and in a second


class Notices(Panel):
    """Shows sentences in browsers, unless there are too many to be read."""

    def __init__(self, clients: Callable[[], Iterable[viser.ClientHandle]]) -> None:
        """Begin; `clients` returns the browsers that are connected."""
        self._clients = clients
        self._lock = threading.Lock()
        self._limit = RateLimit(AT_ONCE, RATE)
        self._left_out = 0

    def tell(self, sentence: str) -> None:
        """Show a sentence, or count it."""
        with self._lock:
            if self._limit.has_one():
                self._show(sentence)
            else:
                self._left_out += 1

    def refresh(self) -> None:
        """Say how many are left out."""
        with self._lock:
            if self._left_out and self._limit.has_one():
                count, self._left_out = self._left_out, 0
                self._show(left_out(count))

    def _show(self, sentence: str) -> None:
        self._limit.take()
        for client in self._clients():
            show_notice(client, sentence)


def show_notice(client: viser.ClientHandle, sentence: str) -> None:
    """Show a sentence in a browser for a while."""
    client.add_notification(plain(sentence, MOST), '', auto_close_seconds=8.0)


def left_out(count: int) -> str:
    """Return a sentence about notices that are not shown."""
    return f'{count} more {"notices are" if count > 1 else "notice is"} left out'
