"""Commands on their way to the loop."""

import contextlib
import threading
from collections import deque
from collections.abc import Callable, Iterator

Command = Callable[[], None]


class CommandQueue:
    """Commands from any thread or signal handler, for one thread that waits for them.

    Not `queue.SimpleQueue`: in Python 3.11 its `get` waits forever if a timeout of some
    microseconds passes before the wait has begun. Not `queue.Queue`: a signal handler that puts
    while its own thread gets would wait forever, too.
    """

    def __init__(self) -> None:
        self._commands: deque[Command] = deque()
        self._news = threading.Lock()  # released while there may be commands
        self._news.acquire()

    def put(self, command: Command) -> None:
        """Append a command, and wake the thread that waits."""
        self._commands.append(command)
        with contextlib.suppress(RuntimeError):  # released already
            self._news.release()

    def take_all(self) -> Iterator[Command]:
        """Remove the commands one by one, also those that arrive meanwhile."""
        self._news.acquire(blocking=False)
        while self._commands:
            yield self._commands.popleft()

    def wait(self, timeout: float | None) -> None:
        """Wait until there is a command, at most for `timeout` > 0 [s, wall]; None: no limit."""
        if not self._commands:
            limit = -1 if timeout is None else min(timeout, threading.TIMEOUT_MAX)
            self._news.acquire(timeout=limit)
