"""Front end of the executable gazebo: the server and, as long as it is open, a window onto it."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from types import FrameType

from .gzclient import display_works

_POLL = 0.1  # [s] between two looks at the children
_GRACE = 5.0  # [s] for a child to end after being asked


def main(arguments: Sequence[str] | None = None) -> int:
    """Run gzserver and gzclient, which lie beside this executable, until either ends.

    The server gets the whole command line, the client only --verbose. Without a display the server
    runs alone.

    Returns:
        The server's exit code.
    """
    arguments = sys.argv[1:] if arguments is None else arguments
    folder = Path(sys.argv[0]).absolute().parent
    # Noted rather than raised, so that no child started just then is left behind. roslaunch and
    # kill send to us alone; a terminal's Ctrl-C goes to the children as well.
    told: list[int] = []
    _on_signals(lambda number, _frame: told.append(number))
    server = subprocess.Popen([sys.executable, folder / 'gzserver', *arguments])
    try:
        client = subprocess.Popen([sys.executable, folder / 'gzclient',
                                   *(word for word in arguments if word == '--verbose')])
        headless = not display_works()  # the client says so and ends at once; the server stays
        while not told and server.poll() is None and (headless or client.poll() is None):
            time.sleep(_POLL)
        _on_signals(signal.default_int_handler)  # whoever asks again does not want to wait
        _end(client, signal.SIGTERM)  # quiet even in a Python that has not begun yet
    finally:
        _end(server, signal.SIGINT)
    return server.returncode


def _on_signals(react: Callable[[int, FrameType | None], object]) -> None:
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, react)


def _end(child: subprocess.Popen, number: signal.Signals) -> None:
    """Ask a child to end; insist after a while."""
    if child.poll() is None:
        child.send_signal(number)
    try:
        child.wait(_GRACE)
    except (subprocess.TimeoutExpired, KeyboardInterrupt):
        child.kill()
        child.wait()
