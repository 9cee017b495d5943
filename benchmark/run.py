#!/usr/bin/env python3
"""Run the named parts of the benchmark; by default all but the long ones.

Each part is a program of this folder, run in its own process. Its estimated and its elapsed time
are shown. All processes that it started are ended with it, also at Ctrl-C and SIGTERM. Arguments
after a single part are passed to it.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import selectors
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import IO, TextIO

from rosbots_description.cli.launched import descendants, send_signal

FOLDER = Path(__file__).resolve().parent
# Duration on two idle processors [s, wall].
PARTS = {
    'fidelity': 45.0,
    'physics': 330.0,
    'veer': 260.0,
    'speed': 560.0,
    'rest': 30.0,
    'real_time': 140.0,
    'sensors': 235.0,
    'arm': 60.0,
    'gym': 180.0,
    'web': 130.0,
    'classroom': 100.0,
}
# only by name
LONG = {
    'batch': 240.0,
    'returns': 720.0,
    'mechanics': 600.0,
    'soak': 1530.0,
    'mutants': 3600.0,
    'fuzz': 1800.0,
}
REMINDER = 30.0  # [s, wall] between two lines of progress where there is no terminal
GRACE = 2.0  # [s, wall] for processes to end after a signal
_BECOME_SUBREAPER = 36  # of prctl: orphaned descendants become our children


class InterruptedPart(Exception):  # noqa: N818  a request, not an error
    """SIGINT or SIGTERM was received."""


class Progress:
    """Shows the elapsed time in the last line of a terminal, else now and then in a new line."""

    def __init__(self, name: str, about: float, stream: TextIO) -> None:
        self._name, self._about, self._stream = name, about, stream
        self._begin = self._told = time.monotonic()
        self._terminal = stream.isatty()

    def show(self) -> None:
        """Show the elapsed time."""
        now = time.monotonic()
        text = f'{self._name}: {now - self._begin:.0f} s of {in_words(self._about)}'
        if self._terminal:
            self._stream.write(f'\r\x1b[K{text}')
            self._stream.flush()
        elif now - self._told >= REMINDER:
            self._told = now
            self._stream.write(f'{text}\n')
            self._stream.flush()

    def hide(self) -> None:
        """Clear the line for the output of the part."""
        if self._terminal:
            self._stream.write('\r\x1b[K')
            self._stream.flush()


def in_words(seconds: float) -> str:
    """Return a duration [s] as rounded text."""
    return f'about {seconds:.0f} s' if seconds < 100.0 else f'about {seconds / 60.0:.0f} min'


def chosen(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return the parts to run, and the arguments for a single part.

    Raises:
        ValueError: a part is unknown.
    """
    known = {**PARTS, **LONG}
    parts = list(arguments) or list(PARTS)
    if len(parts) > 1 and parts[0] in known and parts[1] not in known:
        return parts[:1], parts[1:]
    for part in parts:
        if part not in known:
            raise ValueError(f"there is no benchmark '{part}'; there are: {' '.join(known)}")
    return parts, []


def duration(part: str, arguments: Sequence[str]) -> float:
    """Return the estimated duration of a part [s, wall]."""
    if part == 'soak' and arguments[:1] == ['--seconds'] and len(arguments) > 1:
        with contextlib.suppress(ValueError):
            return 2.5 * float(arguments[1]) + 30.0
    return {**PARTS, **LONG}[part]


def run(command: Sequence[str | Path], name: str, about: float) -> int:
    """Run a program and show progress; end all its processes; return its exit code.

    Raises:
        InterruptedPart: SIGINT or SIGTERM was received.
    """
    with tempfile.TemporaryDirectory(prefix='rosbots_bench_', ignore_cleanup_errors=True) as folder:
        try:
            # Ctrl-C reaches this process only, which ends the part
            part = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                env=os.environ | {'TMPDIR': folder, 'PYTHONUNBUFFERED': '1'},
                start_new_session=True,
            )
            assert part.stdout is not None
            with part.stdout:
                _pass_on(part, part.stdout, Progress(name, about, sys.stderr))
            return part.wait()
        finally:
            end_all()


def _pass_on(part: subprocess.Popen[bytes], output: IO[bytes], progress: Progress) -> None:
    """Forward the part's output until it is closed, and show progress in between."""
    with selectors.DefaultSelector() as selector:
        selector.register(output, selectors.EVENT_READ)
        begun = False  # the last line of output is not complete
        try:
            while True:
                if not selector.select(1.0):
                    if part.poll() is not None:  # only its children keep the output open
                        return
                    if not begun:
                        progress.show()
                    continue
                text = os.read(output.fileno(), 1 << 16)
                if not text:
                    return
                if not begun:
                    progress.hide()
                begun = not text.endswith(b'\n')
                sys.stdout.buffer.write(text)
                sys.stdout.flush()
        finally:
            progress.hide()


def end_all() -> None:
    """End all descendants, orphans too, with SIGINT and then SIGKILL."""
    for number in (signal.SIGINT, signal.SIGKILL):
        end = time.monotonic() + GRACE
        send_signal(descendants(os.getpid()), number)
        while descendants(os.getpid()) and time.monotonic() < end:
            with contextlib.suppress(ChildProcessError):
                os.waitpid(-1, os.WNOHANG)
            if number == signal.SIGKILL:
                send_signal(descendants(os.getpid()), number)  # may have been forked meanwhile
            time.sleep(0.02)


def main(arguments: Sequence[str]) -> int:
    """Run the parts given on the command line; return the exit code."""
    try:
        parts, own = chosen(arguments)
    except ValueError as error:
        sys.stderr.write(f'rosbots: {error}\n')
        return 2
    ctypes.CDLL(None).prctl(_BECOME_SUBREAPER, 1, 0, 0, 0)

    def interrupt(number: int, _frame: object) -> None:
        for other in (signal.SIGINT, signal.SIGTERM):
            signal.signal(other, signal.SIG_IGN)  # the cleanup takes 2 * GRACE at most
        raise InterruptedPart(number)

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, interrupt)
    try:
        if len(parts) > 1:
            total = sum(duration(part, own) for part in parts)
            print(f'{len(parts)} parts, {in_words(total)} in all')
        for part in parts:
            about = duration(part, own)
            print(f'== {part}, {in_words(about)}', flush=True)
            code = run([sys.executable, FOLDER / f'{part}.py', *own], part, about)
            if code:
                return code
    except InterruptedPart as interruption:
        end_all()  # the signal may have interrupted it
        return 128 + int(interruption.args[0])
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
