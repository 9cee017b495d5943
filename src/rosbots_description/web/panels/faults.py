"""What does not work in the world: a list, and a notice for each fault that is new."""

import logging
from collections.abc import Callable, Sequence

import viser

from ...sim.core import Fault, SimError, worst_first
from ..controls import Panel, list_html, markup

MOST = 1000  # characters of a fault
GetFaults = Callable[[], Sequence[Fault]]  # it may raise a SimError


class FaultList(Panel):
    """Shows the faults of the world, the worst first; nothing while there are none."""

    def __init__(self, gui: viser.GuiApi, faults: GetFaults, notify: Callable[[str], None]) -> None:
        self._faults, self._notify = faults, notify
        self._known: set[Fault] | None = None
        self._html = gui.add_html('', visible=False)

    def refresh(self) -> None:
        """Show new faults."""
        try:
            faults = self._faults()
        except SimError:
            return  # there is no simulator, which others say
        known, self._known = self._known, set(faults)
        if known == self._known:
            return
        self._html.content = list_html('Faults', list(map(_entry, worst_first(faults))))
        self._html.visible = bool(faults)
        for fault in faults:
            if known is not None and fault not in known:
                self._notify(str(fault))


def _entry(fault: Fault) -> str:
    text = markup(str(fault), MOST)
    return f'<b>{text}</b>' if fault.severity >= logging.ERROR else text
