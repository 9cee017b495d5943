"""Calls in a child process, for code that may crash, hang or print: each fails the test."""

import contextlib
import faulthandler
import multiprocessing
import os
import resource
import signal
import sys
import tempfile
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

PATIENCE = 60.0  # [s, wall] timeout of what takes milliseconds; a slow machine is no failure

_FORK = multiprocessing.get_context('fork')


class Child:
    """A fork of this process that executes calls on one object; for a `with` statement.

    It starts with a copy of this process's memory, an open world included. Its temporary files are
    removed with it.
    """

    def __init__(self, make: Callable[[], Any]) -> None:
        """Fork; the child creates its object by `make()`."""
        self._output = tempfile.TemporaryFile()  # noqa: SIM115  closed by __exit__
        self._scratch = tempfile.TemporaryDirectory()
        self._pipe, theirs = _FORK.Pipe()
        self._process = _FORK.Process(
            target=_serve, args=(make, theirs, self._output.fileno(), self._scratch.name)
        )
        self._process.start()
        theirs.close()

    def __enter__(self) -> 'Child':
        return self

    def __exit__(self, *_exception: object) -> None:
        self._pipe.close()
        self._process.kill()
        self._process.join()
        self._process.close()
        self._output.close()
        self._scratch.cleanup()

    def call(self, method: str, *arguments: Any) -> Any:
        """Return what the object's method returns.

        Raises:
            AssertionError: the call raised, did not return, printed, or ended the child.
        """
        try:
            self._pipe.send((method, arguments))
            if not self._pipe.poll(PATIENCE):
                raise AssertionError(f'{method} did not end within {PATIENCE:g} s')
            done, result = self._pipe.recv()
        except (EOFError, ConnectionError):
            self._process.join()
            number = -self._process.exitcode
            name = signal.Signals(number).name if number > 0 else f'exit code {-number}'
            raise AssertionError(f'{method} ended the process: {name}\n{self.printed()}') from None
        assert done, f'{method} raised:\n{result}'
        printed = self.printed()
        assert not printed, f'{method} printed: {printed}'
        return result

    def printed(self) -> str:
        """Return the standard output and error of the child so far."""
        size = self._output.seek(0, os.SEEK_END)
        return os.pread(self._output.fileno(), size, 0).decode(errors='replace')


def limit_memory(more: int) -> None:
    """Give this process this many bytes of address space beyond what it has; a child's first call.

    What needs more raises a MemoryError, or ends the process.
    """
    pages = int(Path('/proc/self/statm').read_text().split()[0])
    most = pages * resource.getpagesize() + more
    resource.setrlimit(resource.RLIMIT_AS, (most, most))


def isolated(function: Callable[[], Any]) -> Any:
    """Return what `function()` returns in a child; fail like `Child.call`."""
    with Child(lambda: _Once(function)) as child:
        return child.call('run')


class _Once:
    def __init__(self, function: Callable[[], Any]) -> None:
        self.run = function


def _serve(make: Callable[[], Any], pipe: Any, output: int, scratch: str) -> None:
    """Run the child; none of its exceptions and output reaches the parent's terminal."""
    faulthandler.disable()  # the signal is reported by the parent
    tempfile.tempdir = scratch
    os.dup2(output, sys.__stdout__.fileno())
    os.dup2(output, sys.__stderr__.fileno())
    target = None
    with contextlib.suppress(EOFError, BrokenPipeError):
        while True:
            method, arguments = pipe.recv()
            try:
                target = make() if target is None else target
                answer = (True, getattr(target, method)(*arguments))
            except BaseException:  # reported by the parent
                answer = (False, traceback.format_exc())
            pipe.send(answer)
    os._exit(0)  # without the parent's exit handlers
