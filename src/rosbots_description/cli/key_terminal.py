"""Reads single keys from a terminal."""

from __future__ import annotations

import os
import select
import termios
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_POLL = 0.1  # [s] between calls of `go_on`


@contextmanager
def single_keys(fd: int) -> Iterator[None]:
    """Read keys unbuffered, without echo and including Ctrl-C; restore the terminal at the end.

    Output processing is unchanged, so that lines can be printed as usual.
    """
    saved = termios.tcgetattr(fd)
    mode = termios.tcgetattr(fd)
    mode[3] &= ~(termios.ECHO | termios.ICANON | termios.ISIG | termios.IEXTEN)  # [3]: local modes
    mode[6][termios.VMIN], mode[6][termios.VTIME] = 1, 0  # [6]: control characters
    try:
        termios.tcsetattr(fd, termios.TCSADRAIN, mode)
        yield
    finally:
        termios.tcsetattr(fd, termios.TCSADRAIN, saved)


def read_key(fd: int, timeout: float, go_on: Callable[[], bool]) -> str | None:
    """Return the next key.

    Args:
        fd: file descriptor of a terminal in single_keys mode.
        timeout: longest wait for a key [s, wall].
        go_on: polled; False ends the wait.
    Returns:
        One character; None if no key was pressed.
    Raises:
        EOFError: the terminal was closed.
    """
    end = time.monotonic() + timeout
    while go_on():
        remaining = min(_POLL, end - time.monotonic())
        if remaining < 0.0:
            return None
        if select.select([fd], [], [], remaining)[0]:
            # Unbuffered: keys that arrive together are read one by one.
            try:
                byte = os.read(fd, 1)
            except OSError as error:  # a hang-up on Linux
                raise EOFError('the terminal is gone') from error
            if not byte:
                raise EOFError('the terminal is gone')
            return byte.decode('latin-1')
    return None
