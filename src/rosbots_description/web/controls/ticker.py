"""Work that is done again and again, while there is some."""

import threading
from collections.abc import Callable


class Ticker:
    """Calls a function on a thread of its own between start and stop."""

    def __init__(self, period: float, work: Callable[[], None]) -> None:
        """Note what is done, with a pause of `period` [s, wall] after each time."""
        self._period, self._work = period, work
        self._end: threading.Event | None = None

    def run(self, wanted: bool) -> None:
        """Start or stop, if it has not been done; a call in progress ends by itself."""
        if wanted and self._end is None:
            self._end = threading.Event()
            threading.Thread(target=self._tick, args=(self._end,), daemon=True).start()
        elif not wanted and self._end is not None:
            self._end.set()
            self._end = None

    def _tick(self, end: threading.Event) -> None:
        while not end.wait(self._period):
            self._work()
