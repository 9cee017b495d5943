"""What this library logs, held back until somebody decides what becomes of it."""

import logging
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

_LIBRARY = __name__.partition('.')[0]


class _Keeper(logging.Handler):
    def __init__(self) -> None:
        super().__init__()
        self.kept: list[logging.LogRecord] = []

    def emit(self, record: logging.LogRecord) -> None:
        """Keep a record."""
        self.kept.append(record)


@contextmanager
def held_records(level: int = logging.DEBUG) -> Iterator[list[logging.LogRecord]]:
    """Yield a list to which all is added that this library logs, and that goes nowhere else.

    Args:
        level: what is logged below it is dropped.
    """
    logger, keeper = logging.getLogger(_LIBRARY), _Keeper()
    before = logger.handlers, logger.propagate, logger.level
    logger.handlers, logger.propagate = [keeper], False
    logger.setLevel(level)
    try:
        yield keeper.kept
    finally:
        logger.setLevel(before[2])
        logger.handlers, logger.propagate = before[:2]


def replay(records: Iterable[logging.LogRecord]) -> None:
    """Log held records, at the levels that are enabled now."""
    for record in records:
        logger = logging.getLogger(record.name)
        if logger.isEnabledFor(record.levelno):
            logger.handle(record)
