"""Warnings while a world is loaded: as one message, and the same ones once in a process."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

_SIMULATOR: Final = logging.getLogger(f'{__package__.rpartition(".")[0]}.sim')

_logged: set[str] = set()  # messages of this process


class _WarningCollector(logging.Handler):
    """Collects warnings; whatever else is logged goes on to the parent of the logger."""

    def __init__(self) -> None:
        super().__init__()
        self.warnings: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        """Store or pass on a record."""
        if record.levelno == logging.WARNING:
            self.warnings.append(record.getMessage())
        elif _SIMULATOR.parent is not None:
            _SIMULATOR.parent.handle(record)


@contextmanager
def warnings_as_one(logger: logging.Logger, what: str) -> Iterator[None]:
    """Log the warnings of the simulator in this context as one, if this process has not yet.

    The description of a robot gives the same ones whenever it is loaded.

    Args:
        logger: that logs the one.
        what: is done, with which the message begins.
    """
    collector, propagates = _WarningCollector(), _SIMULATOR.propagate
    _SIMULATOR.addHandler(collector)
    _SIMULATOR.propagate = False
    try:
        yield
    finally:
        _SIMULATOR.propagate = propagates
        _SIMULATOR.removeHandler(collector)
        found = collector.warnings
        count = f'{len(found)} warnings' if len(found) > 1 else 'a warning'
        message = f'{what} gave {count}, not to be repeated: {"; ".join(found)}'
        if found and message not in _logged:
            _logged.add(message)
            logger.warning('%s', message)
