"""A process of its own for what may crash, hang or chatter: each of these is a failed test."""

import contextlib
import faulthandler
import multiprocessing
import os
import signal
import sys
import tempfile
import traceback
from collections.abc import Callable
from typing import Any

PATIENCE = 60.0  # [s, wall] for what takes milliseconds; slow machines are no failure

_FORK = multiprocessing.get_context('fork')


class Child:
    """A copy of this process that carries out calls on one object; for a `with` statement.

    It begins with everything as it is here, an open world included, and changes nothing here.
    """

    def __init__(self, make: Callable[[], Any]) -> None:
        """Fork, and let the child make its object by `make()`."""
        self._output = tempfile.TemporaryFile()  # noqa: SIM115  closed by __exit__
        self._pipe, theirs = _FORK.Pipe()
        self._process = _FORK.Process(target=_serve, args=(make, theirs, self._output.fileno()))
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

    def call(self, method: str, *arguments: Any) -> Any:
        """Return what the object's method returns.

        Raises:
            AssertionError: it raised something, did not end, printed something, or the child died.
        """
        self._pipe.send((method, arguments))
        if not self._pipe.poll(PATIENCE):
            raise AssertionError(f'{method} did not end within {PATIENCE:g} s')
        try:
            done, result = self._pipe.recv()
        except EOFError:
            self._process.join()
            number = -self._process.exitcode
            name = signal.Signals(number).name if number > 0 else f'exit code {-number}'
            raise AssertionError(f'{method} ended the process: {name}') from None
        assert done, f'{method} raised:\n{result}'
        printed = self.printed()
        assert not printed, f'{method} printed: {printed}'
        return result

    def printed(self) -> str:
        """Return all that came out on the child's standard output and error."""
        size = self._output.seek(0, os.SEEK_END)
        return os.pread(self._output.fileno(), size, 0).decode(errors='replace')


def isolated(function: Callable[[], Any]) -> Any:
    """Return what `function()` returns in a child; see `Child.call` for what is a failure."""
    with Child(lambda: _Once(function)) as child:
        return child.call('run')


class _Once:
    def __init__(self, function: Callable[[], Any]) -> None:
        self.run = function


def _serve(make: Callable[[], Any], pipe: Any, output: int) -> None:
    """Be the child: no exception and no output of it reaches the parent's terminal."""
    faulthandler.disable()  # what happened is told by the signal
    os.dup2(output, sys.__stdout__.fileno())
    os.dup2(output, sys.__stderr__.fileno())
    target = None
    with contextlib.suppress(EOFError, BrokenPipeError):
        while True:
            method, arguments = pipe.recv()
            try:
                target = make() if target is None else target
                answer = (True, getattr(target, method)(*arguments))
            except BaseException:  # whatever it is, the parent judges
                answer = (False, traceback.format_exc())
            pipe.send(answer)
    os._exit(0)  # without what the parent registered for its own end
