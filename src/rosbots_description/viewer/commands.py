"""Commands of the page, carried out by the thread that owns the world."""

import logging
import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from typing import TypeVar

from ..sim import SimError

logger = logging.getLogger(__name__)

Value = TypeVar('Value')
PATIENCE = 10.0  # [s, wall] for the result of a command
BUSY = (
    'the program does not run its world at the moment, so the command is dropped; '
    'it is carried out while the program runs it'
)


class WorldCommands:
    """A queue that any thread may fill, and that the owner of the world empties between steps."""

    def __init__(self, changed: threading.Condition) -> None:
        """Begin empty; `changed` is notified of each command."""
        self._changed = changed
        # Each as two functions: one carries it out, one refuses it.
        self._waiting: deque[tuple[Callable[[], None], Callable[[], object]]] = deque()
        self._is_over = False

    @property
    def are_waiting(self) -> bool:
        """Return whether there is one."""
        return bool(self._waiting)

    def call(self, command: Callable[[], Value], patience: float = PATIENCE) -> Value:
        """Return the result of a command.

        Args:
            patience: for its result [s, wall]; a command that has not begun by then never does.
        Raises:
            SimError: it was refused, or not begun in time.
        """
        result: Future[Value] = Future()

        def carry_out() -> None:
            if result.set_running_or_notify_cancel():
                try:
                    result.set_result(command())
                except Exception as error:  # it goes to the caller
                    result.set_exception(error)

        self._add(carry_out, result.cancel)
        try:
            return result.result(patience)
        except (CancelledError, TimeoutError):
            if result.cancel():
                raise SimError(BUSY) from None
            return result.result()
        except ValueError as error:  # a number is out of range
            raise SimError(str(error)) from error

    def post(self, command: Callable[[], object]) -> None:
        """Have a command carried out; an error is logged."""

        def carry_out() -> None:
            try:
                command()
            except (SimError, ValueError) as error:
                logger.warning('%s', error)

        self._add(carry_out, lambda: None)

    def carry_out(self) -> None:
        """Carry out what waits; to be called by the thread that owns the world."""
        for _ in range(len(self._waiting)):
            act, _refuse = self._waiting.popleft()
            act()

    def end(self) -> None:
        """Refuse what waits, and what comes; to be called by the thread that owns the world."""
        with self._changed:
            self._is_over = True
        while self._waiting:
            _act, refuse = self._waiting.popleft()
            refuse()

    def _add(self, act: Callable[[], None], refuse: Callable[[], object]) -> None:
        with self._changed:
            if not self._is_over:
                self._waiting.append((act, refuse))
                self._changed.notify_all()
                return
        refuse()
