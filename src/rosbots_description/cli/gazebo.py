"""Front end of the executable gazebo, which runs gzserver and gzclient."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from types import FrameType

from .display import display_works

_POLL = 0.1  # [s] between polls of the child processes
_GRACE = 5.0  # [s] for a child to end after a signal


def main(arguments: Sequence[str] | None = None) -> int:
    """Run gzserver and gzclient, from the folder of this executable, until either ends.

    The server gets the whole command line, the client only --verbose. Without a display the server
    runs alone.

    Returns:
        The server's exit code.
    """
    arguments = sys.argv[1:] if arguments is None else arguments
    folder = Path(sys.argv[0]).absolute().parent
    # Recorded, not raised: an exception while a child starts could leave it behind. roslaunch and
    # kill signal this process only; Ctrl-C in a terminal signals the children as well.
    told: list[int] = []
    _on_signals(lambda number, _frame: told.append(number))
    server = subprocess.Popen([sys.executable, folder / 'gzserver', *arguments])
    try:
        _use_simulated_time()
        client = subprocess.Popen(
            [
                sys.executable,
                folder / 'gzclient',
                *(word for word in arguments if word == '--verbose'),
            ]
        )
        headless = not display_works()  # then the client ends at once, and the server continues
        while not told and server.poll() is None and (headless or client.poll() is None):
            time.sleep(_POLL)
        _on_signals(signal.default_int_handler)  # a second signal ends the wait
        _end(client, signal.SIGTERM)  # SIGINT could cause a traceback while Python starts
    finally:
        _end(server, signal.SIGINT)
    return server.returncode


def _use_simulated_time() -> None:
    """Set /use_sim_time before the window starts, as empty_world.launch does.

    Otherwise its panel Time would show the wall clock: the server sets it too late for that.
    """
    from ..ros_api.transport import use_simulated_time  # slow to import, so while the server starts

    use_simulated_time('/gazebo_gui')


def _on_signals(react: Callable[[int, FrameType | None], object]) -> None:
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, react)


def _end(child: subprocess.Popen[bytes], number: signal.Signals) -> None:
    """Signal a child to end; kill it after a timeout."""
    if child.poll() is None:
        child.send_signal(number)
    try:
        child.wait(_GRACE)
    except (subprocess.TimeoutExpired, KeyboardInterrupt):
        child.kill()
        child.wait()
