"""Sentences to all who look at the page."""

import threading
import time

import viser

from .panel import Panel
from .text import plain

MOST = 1000  # characters of a notice
AT_ONCE, RATE = 20.0, 2.0  # notices at once, and in a second


class Notices(Panel):
    """Shows sentences in all browsers, unless there are too many to be read."""

    def __init__(self, site: viser.ViserServer) -> None:
        self._site = site
        self._lock = threading.Lock()
        self._allowed, self._counted = AT_ONCE, time.monotonic()
        self._left_out = 0

    def tell(self, sentence: str) -> None:
        """Show a sentence, or count it."""
        with self._lock:
            if self._may_show():
                self._show(sentence)
            else:
                self._left_out += 1

    def refresh(self) -> None:
        """Say how many are left out."""
        with self._lock:
            if self._left_out and self._may_show():
                count, self._left_out = self._left_out, 0
                self._show(left_out(count))

    def _may_show(self) -> bool:
        now = time.monotonic()
        self._allowed = min(AT_ONCE, self._allowed + RATE * (now - self._counted))
        self._counted = now
        if self._allowed < 1.0:
            return False
        self._allowed -= 1.0
        return True

    def _show(self, sentence: str) -> None:
        for client in self._site.get_clients().values():
            show(client, sentence)


def show(client: viser.ClientHandle, sentence: str) -> None:
    """Show a sentence in a browser for a while."""
    client.add_notification(plain(sentence, MOST), '', auto_close_seconds=8.0)


def left_out(count: int) -> str:
    """Return a sentence about notices that are not shown."""
    return f'{count} more {"notices are" if count > 1 else "notice is"} left out'
