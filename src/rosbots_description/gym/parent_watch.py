"""No process of multiprocessing outlives the process that started it."""

import multiprocessing
import os
import select
import threading
from functools import cache


def end_with_parent() -> None:
    """End this process as soon as the one that started it has ended, however it did.

    In a process that multiprocessing did not start this does nothing. The kernel tells of the end,
    also of one by SIGKILL; pipes do not, as long as sister processes have inherited their ends.
    """
    parent = multiprocessing.parent_process()
    if parent is not None and parent.pid is not None:
        _watch(os.getpid(), parent.pid)


@cache
def _watch(_own: int, parent: int) -> None:
    """Watch a parent; once for each process, as a fork copies the cache."""
    try:
        handle = os.pidfd_open(parent)
    except ProcessLookupError:
        os._exit(1)
    threading.Thread(target=_wait, args=(handle,), name='parent watch', daemon=True).start()


def _wait(handle: int) -> None:
    select.select([handle], [], [])
    os._exit(1)
