"""A roslaunch of our own that leaves nothing behind."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

_PATIENCE = 1.5  # [s] wall time to end well in; Ctrl-C has to end everything within 2 s

_ESCAPE = re.compile(r'\x1b\[[0-9;]*m|\x1b\][^\x07]*\x07')  # colours, and titles of the terminal


class Launched:
    """A running roslaunch; as a context manager it is ended at the end of the block."""

    def __init__(self, arguments: Sequence[str], log: Path, environment: Mapping[str, str]) -> None:
        """Start `roslaunch arguments…`, with its output in the file `log`."""
        self.log = log
        with log.open('wb') as output:
            # a session of its own, so that Ctrl-C reaches only us and we choose the order
            self._process = subprocess.Popen(
                ['/usr/bin/roslaunch', *arguments], stdin=subprocess.DEVNULL, stdout=output,
                stderr=subprocess.STDOUT, env=environment, start_new_session=True)

    def __enter__(self) -> Launched:
        return self

    def __exit__(self, *_exception: object) -> None:
        self.stop()

    @property
    def running(self) -> bool:
        """Tell whether roslaunch itself still runs."""
        return self._process.poll() is None

    def wait(self, timeout: float) -> bool:
        """Wait until it has ended by itself; tell whether it did within `timeout` [s, wall]."""
        try:
            self._process.wait(timeout)
        except subprocess.TimeoutExpired:
            return False
        return True

    def stop(self) -> None:
        """End roslaunch and all its nodes; by force when they do not listen.

        roslaunch alone ends its nodes one by one, and hears nothing while it starts a master; so
        everyone is told at once.
        """
        family = self._family()
        send_signal(family, signal.SIGINT)
        self.wait(_PATIENCE)
        # those that came meanwhile, too
        send_signal({*family, *self._family()}, signal.SIGKILL)
        self._process.wait()

    def _family(self) -> set[int]:
        """Return the ids of roslaunch and everything below it; none once it has ended."""
        if not self.running:
            return set()
        return {self._process.pid, *descendants(self._process.pid)}

    def complaint(self) -> str:
        """Return the last line of the output that tells of an error, and where to read more."""
        text = _ESCAPE.sub('', self.log.read_text(errors='replace'))
        errors = [re.sub(', cmd .*', ']', line) for line in text.splitlines()
                  if any(word in line for word in ('ERROR', 'FATAL', 'has died'))]
        return f'{errors[-1]} (see {self.log})' if errors else f'see {self.log}'


def descendants(pid: int) -> list[int]:
    """Return the ids of all processes below `pid`; roslaunch gives each node its own session."""
    found = []
    for task in Path(f'/proc/{pid}/task').glob('*/children'):
        with contextlib.suppress(OSError):
            for child in map(int, task.read_text().split()):
                found += [child, *descendants(child)]
    return found


def send_signal(pids: Iterable[int], number: signal.Signals) -> None:
    """Send a signal to those of the processes that still run."""
    for pid in pids:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, number)
