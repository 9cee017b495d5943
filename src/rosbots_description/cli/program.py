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
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

INTERRUPTED = 130  # exit code, as shells have it for who was ended by Ctrl-C


def run(main: Callable[[], int]) -> int:
    """Return `main()`, with surroundings that it can rely on.

    Ctrl-C that `main` does not expect, such as while modules are loaded, ends it without a word.
    """
    _speak_utf8()
    _take_its_name()
    _occupy_closed_descriptors()
    sys.stdin = sys.stdin or open(os.devnull, encoding='utf-8')  # noqa: SIM115
    sys.stdout, sys.stderr = _patient(sys.stdout), _patient(sys.stderr)
    try:
        return main()
    except KeyboardInterrupt:
        return INTERRUPTED


def _speak_utf8() -> None:
    """Begin anew in Python's UTF-8 mode where the locale has another encoding.

    Python takes that one for the names of files, and it cannot be changed later. Without
    LC_ALL and with the locale C, Python does this itself.
    """
    if sys.getfilesystemencoding() != 'utf-8':
        os.environ['PYTHONUTF8'] = '1'  # for the programs that this one starts
        os.execv(sys.executable, [sys.executable, '-X', 'utf8', *sys.orig_argv[1:]])


def _take_its_name() -> None:
    """Let `killall gzserver` and the like find this program, as they find Gazebo's."""
    with contextlib.suppress(OSError):
        Path('/proc/self/comm').write_text(Path(sys.argv[0]).name, encoding='utf-8')


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

    def write(self, content: ReadableBuffer) -> int:
        with contextlib.suppress(OSError):
            written = super().write(content)
            if written is not None:  # else it would have to wait, and somebody has forbidden it
                return written
        return memoryview(content).nbytes
