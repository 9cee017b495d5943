"""Runs roslaunch, and ends all its processes."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path

_TIMEOUT = 1.5  # [s] wall time for a clean end, within the 2 s that Ctrl-C may take

_ESCAPE = re.compile(r'\x1b\[[0-9;]*m|\x1b\][^\x07]*\x07')  # colours and terminal titles


class Launched:
    """A running roslaunch; as a context manager it is stopped at the end of the block."""

    def __init__(self, arguments: Sequence[str], log: Path, environment: Mapping[str, str]) -> None:
        """Start `roslaunch arguments…`, with its output in the file `log`."""
        self.log = log
        # Its owner's alone: the address of the page, with the token, may be in it.
        with open(log, 'wb', opener=partial(os.open, mode=0o600)) as output:
            # a new session: Ctrl-C reaches only this process, which ends the others in order
            self._process = subprocess.Popen(
                ['/usr/bin/roslaunch', *arguments],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                env=environment,
                start_new_session=True,
            )

    def __enter__(self) -> Launched:
        return self

    def __exit__(self, *_exception: object) -> None:
        self.stop()

    @property
    def running(self) -> bool:
        """Tell whether roslaunch itself is running."""
        return self._process.poll() is None

    def wait(self, timeout: float) -> bool:
        """Wait until roslaunch ends by itself; tell whether it did within `timeout` [s, wall]."""
        try:
            self._process.wait(timeout)
        except subprocess.TimeoutExpired:
            return False
        return True

    def stop(self) -> None:
        """End roslaunch and all its nodes; kill those that do not end in time.

        roslaunch ends its nodes one by one, and ignores signals while it starts a master. So all
        processes are signalled at once.
        """
        processes = self._process_tree()
        send_signal(processes, signal.SIGINT)
        self.wait(_TIMEOUT)
        # including processes started meanwhile
        send_signal({*processes, *self._process_tree()}, signal.SIGKILL)
        self._process.wait()

    def _process_tree(self) -> set[int]:
        """Return the ids of roslaunch and its descendants; none after it has ended."""
        if not self.running:
            return set()
        return {self._process.pid, *descendants(self._process.pid)}

    def error(self) -> str:
        """Return the last error line of the output, and the path of the log."""
        text = _ESCAPE.sub('', self.log.read_text(errors='replace'))
        errors = [
            re.sub(', cmd .*', ']', line)
            for line in text.splitlines()
            if any(word in line for word in ('ERROR', 'FATAL', 'has died'))
        ]
        return f'{errors[-1]} (see {self.log})' if errors else f'see {self.log}'


def descendants(pid: int) -> list[int]:
    """Return the ids of all descendants of `pid`; roslaunch gives each node its own session."""
    found = []
    for task in Path(f'/proc/{pid}/task').glob('*/children'):
        with contextlib.suppress(OSError):
            for child in map(int, task.read_text().split()):
                found += [child, *descendants(child)]
    return found


def send_signal(pids: Iterable[int], number: signal.Signals) -> None:
    """Send a signal to the processes that are still running."""
    for pid in pids:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, number)
