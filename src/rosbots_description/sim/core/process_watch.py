"""Tell whether another process makes no progress, from its state and the processor time it used.

Wall time alone says nothing on a busy machine: a process that waits for a processor or a disk is
neither asleep nor stopped.
"""

import os

POLL_PERIOD = 0.5  # [s, wall] between two calls of the same method of a watch
MAX_SLEEPING_POLLS = 20  # consecutive calls that may find it asleep, with no processor time used
HUNG_TIME = POLL_PERIOD * MAX_SLEEPING_POLLS  # [s, wall]
MAX_STOPPED_POLLS = 1  # consecutive calls that may find it stopped, as while Ctrl-Z stops all

_SLEEPING, _STOPPED = b'S', b'T'
_TICK = 1.0 / os.sysconf('SC_CLK_TCK')  # [s]


class ProcessWatch:
    """Polls one process, which the caller has not waited for yet."""

    def __init__(self, process: int) -> None:
        self._path = f'/proc/{process}/stat'
        self._used = 0.0  # [s, processor] at the last call
        self._sleeping_polls = self._stopped_polls = 0  # in a row

    def is_stopped(self) -> bool:
        """Tell whether a signal such as SIGSTOP keeps the process from running."""
        self._poll()
        return self._stopped_polls > MAX_STOPPED_POLLS

    def is_hung(self) -> bool:
        """Tell whether a process that has work to do is stopped, or sleeps and does none."""
        self._poll()
        return self._stopped_polls > MAX_STOPPED_POLLS or self._sleeping_polls > MAX_SLEEPING_POLLS

    def _poll(self) -> None:
        with open(self._path, 'rb') as file:
            state, *fields = file.read().rpartition(b') ')[2].split()
        used = _TICK * (int(fields[10]) + int(fields[11]))  # in user mode and in the kernel
        asleep = state == _SLEEPING and used == self._used
        self._sleeping_polls = self._sleeping_polls + 1 if asleep else 0
        self._stopped_polls = self._stopped_polls + 1 if state == _STOPPED else 0
        self._used = used
