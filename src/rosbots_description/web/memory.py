"""What a visit has used, given back to the system."""

import contextlib
import ctypes


def return_memory() -> None:
    """Return free memory to the system.

    glibc keeps it, for each thread: the pictures of many visits, each read on other threads, would
    hold 30 to 60 MB that nobody uses. Other C libraries have no such function.
    """
    with contextlib.suppress(AttributeError):
        ctypes.CDLL(None).malloc_trim(0)
