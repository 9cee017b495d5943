"""What each of our programs does first, so that nothing around it can end it with a traceback.

File names and texts are UTF-8 whatever the locale says, and standard streams take every text: one
that is closed, full or whose reader has gone swallows what is written to it.
"""

from __future__ import annotations

import contextlib
import io
import os
import sys
from collections.abc import Callable
from typing import TextIO


def run(main: Callable[[], int]) -> int:
    """Return `main()`, with surroundings that it can rely on."""
    _speak_utf8()
    _occupy_closed_descriptors()
    sys.stdin = sys.stdin or open(os.devnull, encoding='utf-8')  # noqa: SIM115
    sys.stdout, sys.stderr = _patient(sys.stdout), _patient(sys.stderr)
    return main()


def _speak_utf8() -> None:
    """Begin anew in Python's UTF-8 mode where the locale has another encoding.

    Python takes that one for the names of files, and it cannot be changed later. Without
    LC_ALL and with the locale C, Python does this itself.
    """
    if sys.getfilesystemencoding() != 'utf-8':
        os.environ['PYTHONUTF8'] = '1'  # for the programs that this one starts
        os.execv(sys.executable, [sys.executable, '-X', 'utf8', *sys.orig_argv[1:]])


def _occupy_closed_descriptors() -> None:
    """Let no file or connection get the number of a standard stream, to which C code prints."""
    for descriptor in range(3):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest number, which is this one


def _patient(stream: TextIO | None) -> TextIO:
    """Return a stream to the same place that writes line by line and never fails."""
    descriptor = os.open(os.devnull, os.O_WRONLY) if stream is None else stream.fileno()
    return io.TextIOWrapper(
        io.BufferedWriter(_Patient(descriptor, 'w', closefd=False)),
        encoding=stream.encoding if stream else 'utf-8',
        errors='backslashreplace',
        line_buffering=True,
    )


class _Patient(io.FileIO):
    """A file that drops what cannot be written."""

    def write(self, content) -> int:
        with contextlib.suppress(OSError):
            written = super().write(content)
            if written is not None:  # else it would have to wait, and somebody has forbidden it
                return written
        return len(content)
