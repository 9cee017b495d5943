"""Is there a display for a window, and one that a program opens there, until it is closed."""

import contextlib
import ctypes
import ctypes.util
import os
import signal
import subprocess
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

_PR_SET_PDEATHSIG = 1  # of prctl(2)
PERIOD = 1.0  # time between polls while a window is open [s]
# Debian's RViz 1.14 sometimes corrupts its heap as it opens: its library Ogre makes a window over
# one connection to the X server, and draws on it over another without waiting for the first. If
# the second is faster, there is no window yet; without a graphics card, Mesa then takes its size
# for 0, allocates no memory for its picture, and draws there. On two busy processors that is so in
# one of 28 starts. Later crashes have other causes and would recur, so they are not retried.
STARTS = 4  # at most
OPENS = 30.0  # time within which a crash counts as one of the start [s]
CARDS = 'dri/renderD*', 'nvidia0', 'dxg'  # in /dev: of Linux, of NVIDIA's driver, of Windows
CRASHES = {-signal.SIGSEGV, -signal.SIGABRT, -signal.SIGBUS}


def display_works() -> bool:
    """Tell whether an X server can be reached; without one RViz would abort."""
    if not os.environ.get('DISPLAY'):
        return False
    library = ctypes.util.find_library('X11')
    if library is None:
        return False
    x11 = ctypes.CDLL(library)
    x11.XOpenDisplay.restype = ctypes.c_void_p
    display = x11.XOpenDisplay(None)
    if not display:
        return False
    x11.XCloseDisplay(ctypes.c_void_p(display))
    return True


def has_graphics_card() -> bool:
    """Tell whether programs draw on one here; else it is done in software."""
    return any(any(Path('/dev').glob(card)) for card in CARDS)


def no_window() -> str:
    """Return the sentence for those who have no display."""
    display = os.environ.get('DISPLAY') or 'not set'
    return f'no window: there is no display to open it on (DISPLAY is {display})'


def run_window(
    command: Sequence[str],
    environment: Mapping[str, str],
    say: Callable[[str], None],
    poll: Callable[[], None] = lambda: None,
) -> int:
    """Run a program with a window until it is closed; return its exit code, 0 after a signal.

    Args:
        command: the program and its arguments. If it crashes as it opens, it is started again.
        environment: its environment variables.
        say: is told what the program did, such as 'crashed as it opened (SIGSEGV)'.
        poll: is called every PERIOD while the window is open.
    """
    received: list[int | None] = []
    window: subprocess.Popen[bytes] | None = None

    def end(number: int | None = None, _frame: object = None) -> None:
        received.append(number)
        if window is not None:
            window.send_signal(signal.SIGINT)  # RViz then unregisters from the master

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, end)
    for left in reversed(range(STARTS)):
        started = time.monotonic()
        window = subprocess.Popen(command, env=environment, preexec_fn=_end_with_parent)  # noqa: PLW1509  it only calls the kernel
        if received:  # a signal arrived during the start
            end()
        while window.poll() is None and not received:  # no polls while shutting down
            poll()
            with contextlib.suppress(subprocess.TimeoutExpired):
                window.wait(PERIOD)
        code = window.wait()
        if received or code not in CRASHES or time.monotonic() - started > OPENS:
            break
        say(
            f'crashed as it opened ({signal.Signals(-code).name}); '
            + ('restarting it' if left else f'no window after {STARTS} starts')
        )
    if not received:
        return code if code >= 0 else 128 - code  # 128 + signal, as in shells
    if code in CRASHES:
        say(f'crashed as it was closed ({signal.Signals(-code).name})')
    return 0


def _end_with_parent() -> None:
    """Let the kernel signal this process when its parent is killed."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGINT)
