"""Common start of all programs, which prevents tracebacks from the environment.

File names and texts are UTF-8 in any locale. Standard streams accept any text: output to a stream
that is closed, full or without a reader is discarded.
"""

from __future__ import annotations

import contextlib
import gc
import io
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

INTERRUPTED = 130  # exit code after Ctrl-C, as in shells


def run(main: Callable[[], int]) -> int:
    """Return `main()`, with encoding and standard streams set up.

    Ctrl-C that `main` does not handle, such as during imports, ends the program silently.
    """
    _use_utf8()
    # Else numpy's library starts a thread for each processor, which spins for 0.1 s.
    os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
    _set_process_name()
    _occupy_closed_descriptors()
    sys.stdin = sys.stdin or open(os.devnull, encoding='utf-8')  # noqa: SIM115
    sys.stdout, sys.stderr = _tolerant(sys.stdout), _tolerant(sys.stderr)
    try:
        return main()
    except KeyboardInterrupt:
        return INTERRUPTED
    finally:
        gc.freeze()  # else Python looks for unreachable objects in all modules before it ends


def say(program: str, sentence: str) -> None:
    """Print a sentence of a program on standard error."""
    sys.stderr.write(f'{program}: {sentence}\n')


def fail(program: str, sentence: str, code: int = 1) -> int:
    """Print why a program fails; return its exit code."""
    say(program, sentence)
    return code


def _use_utf8() -> None:
    """Restart in Python's UTF-8 mode if the locale has another encoding.

    The encoding of file names cannot be changed at run time. In the locale C without LC_ALL, Python
    uses UTF-8 by itself.
    """
    if sys.getfilesystemencoding() != 'utf-8':
        os.environ['PYTHONUTF8'] = '1'  # for child processes
        os.execv(sys.executable, [sys.executable, '-X', 'utf8', *sys.orig_argv[1:]])


def _set_process_name() -> None:
    """Set the process name to the script's, so that `killall gzserver` works as with Gazebo."""
    with contextlib.suppress(OSError):
        Path('/proc/self/comm').write_text(Path(sys.argv[0]).name, encoding='utf-8')


def _occupy_closed_descriptors() -> None:
    """Reserve the numbers of closed standard streams, to which C code prints."""
    for descriptor in range(3):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest free number: this one


def _tolerant(stream: TextIO | None) -> TextIO:
    """Return a line-buffered stream to the same descriptor whose writes never fail."""
    descriptor = os.open(os.devnull, os.O_WRONLY) if stream is None else stream.fileno()
    return io.TextIOWrapper(
        io.BufferedWriter(_TolerantFile(descriptor, 'w', closefd=False)),
        encoding=stream.encoding if stream else 'utf-8',
        errors='backslashreplace',
        line_buffering=True,
    )


class _TolerantFile(io.FileIO):
    """A file that discards what cannot be written."""

    def write(self, content: ReadableBuffer) -> int:
        with contextlib.suppress(OSError):
            written = super().write(content)
            if written is not None:  # None: a non-blocking descriptor is full
                return written
        return memoryview(content).nbytes
