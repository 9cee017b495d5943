"""Warnings while a world is loaded: as one message, and the same ones once in a process."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager

from ..sim.core import held_records, replay

_logged: set[str] = set()  # messages of this process


@contextmanager
def warnings_as_one(logger: logging.Logger, what: str) -> Iterator[None]:
    """Log the warnings in this context as one, if this process has not yet, after what else is.

    The description of a robot gives the same ones whenever it is loaded.

    Args:
        logger: that logs the one.
        what: is done, with which the message begins.
    """
    records: list[logging.LogRecord] = []
    try:
        with held_records() as records:
            yield
    finally:
        replay(one for one in records if one.levelno != logging.WARNING)
        found = [one.getMessage() for one in records if one.levelno == logging.WARNING]
        count = f'{len(found)} warnings' if len(found) > 1 else 'a warning'
        message = f'{what} gave {count}, not to be repeated: {"; ".join(found)}'
        if found and message not in _logged:
            _logged.add(message)
            logger.warning('%s', message)
