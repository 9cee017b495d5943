"""What panels share that read something only while it is chosen and a browser is connected."""

import threading

from .panel import Panel
from .ticker import Ticker


class ReadingPanel(Panel):
    """Begins and ends to read, and ticks while there is something to read."""

    def __init__(self, period: float) -> None:
        """Begin with nothing; `period` is from one tick to the next [s, wall]."""
        self._lock = threading.RLock()
        self._ticker = Ticker(period, self._tick)
        self._open: set[str] = set()  # what is read
        self._is_seen = False

    def open(self) -> None:
        """Read what is chosen."""
        with self._lock:
            self._is_seen = True
            self._read_chosen()

    def close(self) -> None:
        """Read nothing until a browser connects again."""
        with self._lock:
            self._is_seen = False
            self._read_chosen()

    def _read_chosen(self) -> None:
        """Read what is chosen and nothing else; to be called with the lock."""
        wanted = self._chosen() if self._is_seen else set()
        for name in self._open - wanted:
            self._end(name)
        self._open &= wanted
        self._open |= {name for name in wanted - self._open if self._begin(name)}
        self._ticker.run(bool(self._open))

    def _chosen(self) -> set[str]:
        """Return the names of what is chosen."""
        raise NotImplementedError

    def _begin(self, name: str) -> bool:
        """Begin to read; return whether that was possible."""
        raise NotImplementedError

    def _end(self, name: str) -> None:
        """End that."""
        raise NotImplementedError

    def _tick(self) -> None:
        """Show what has come."""
        raise NotImplementedError
