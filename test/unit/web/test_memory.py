"""Free memory goes back to the system when the last browser leaves."""

import ctypes
import gc
import threading

from support.patience import wait_until

from rosbots_description.web import page as pages
from rosbots_description.web.memory import return_memory

MANY, LARGE = 2000, 60_000  # pieces, each below the size from which glibc maps it by itself [bytes]


def resident():
    """Return what this process has in memory [bytes]."""
    with open('/proc/self/statm', encoding='ascii') as file:
        return int(file.read().split()[1]) * 4096


def test_free_memory_of_other_threads_is_returned():
    libc = ctypes.CDLL(None)
    libc.malloc.restype, libc.free.argtypes = ctypes.c_void_p, [ctypes.c_void_p]

    def use():
        pieces = [libc.malloc(LARGE) for _ in range(MANY)]
        for piece in pieces:
            ctypes.memset(piece, 1, LARGE)
        for piece in pieces[:-1]:  # the last one keeps the heap from shrinking by itself
            libc.free(piece)

    thread = threading.Thread(target=use)
    thread.start()
    thread.join()
    gc.collect()
    before = resident()
    return_memory()
    assert before - resident() > 0.5 * MANY * LARGE


def test_the_last_browser_that_leaves_returns_it(monkeypatch, simulator, browser):
    returned = []
    monkeypatch.setattr(pages, 'return_memory', lambda: returned.append(simulator.change))
    browser.__exit__()
    wait_until(lambda: returned)
    assert returned == [None]
