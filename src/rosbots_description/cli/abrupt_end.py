"""Report the end of a program that a library ends by C's exit(), past all of Python."""

import contextlib
import os
import signal
from collections.abc import Iterator


@contextlib.contextmanager
def reported(sentence: str) -> Iterator[None]:
    """Print a sentence on standard error if this process ends within the `with` statement.

    A child process waits for that; enter before there are threads.
    """
    waits, held = os.pipe()
    child = os.fork()
    if not child:
        os.close(held)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_IGN)  # meant for the program
        if not os.read(waits, 1):
            with contextlib.suppress(OSError):
                os.write(2, f'{sentence}\n'.encode())
        os._exit(0)
    os.close(waits)
    try:
        yield
    finally:
        os.write(held, b'.')
        os.close(held)
        os.waitpid(child, 0)
