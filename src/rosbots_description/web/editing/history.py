"""Undo of the last changes by hand."""

import threading
from collections import deque
from collections.abc import Callable

import viser

from ...sim.description import ShownMotion
from ..controls import Panel, attempt, plain

MOST = 10  # changes that can be undone


class History(Panel):
    """The changes that were made by hand, in all browsers alike; thread-safe."""

    def __init__(self, gui: viser.GuiApi, complain: Callable[[str], None]) -> None:
        self._complain = complain
        # Held during a change by hand or an undo, each of which begins where the last has ended.
        self.turn = threading.Lock()
        self._lock = threading.Lock()  # of the changes
        self._changes: deque[tuple[str, Callable[[], object]]] = deque(maxlen=MOST)
        self._real_time = 0.0  # of the simulator [s]
        self._button = gui.add_button('Undo', icon=viser.Icon.ARROW_BACK_UP, disabled=True)
        self._button.on_click(lambda _: self.undo())
        gui.add_command('Undo', hotkey='Z', modifier='cmd/ctrl').on_trigger(lambda _: self.undo())

    def add(self, what: str, undo: Callable[[], object]) -> None:
        """Remember a change.

        Args:
            what: was done, as in "move 'box'".
            undo: called from any thread, at most once; it may raise SimError.
        """
        with self._lock:
            self._changes.append((what, undo))
            self._show()

    def undo(self) -> None:
        """Undo the last change; a refusal is shown, and the change forgotten all the same.

        The one before it is offered when this one is undone.
        """
        with self.turn:
            with self._lock:
                if not self._changes:
                    return
                what, undo = self._changes.pop()
            attempt(undo, lambda reason: self._complain(f'Undo: {what}: {reason}'))
            with self._lock:
                self._show()

    def move(self, motion: ShownMotion) -> None:
        """Forget the changes of a simulator that has ended."""
        if motion.real_time < self._real_time:
            with self._lock:
                self._changes.clear()
                self._show()
        self._real_time = motion.real_time

    def _show(self) -> None:
        self._button.label = f'Undo: {plain(self._changes[-1][0])}' if self._changes else 'Undo'
        self._button.disabled = not self._changes
