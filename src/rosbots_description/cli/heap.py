"""Memory that a process has used, given back to the system."""

import contextlib
import ctypes

_M_MMAP_THRESHOLD, _M_ARENA_MAX = -3, -8  # of glibc's mallopt(3)
LARGE = 1 << 17  # [bytes] glibc's own first threshold


def use_one_heap() -> None:
    """Let all threads use one heap, and keep large pieces out of it; before threads begin.

    glibc gives threads heaps of their own, and puts larger pieces there once one was freed. Threads
    that come and go, as those of ROS's connections, leave holes in each, which only that heap can
    use: 60 MB and more in gzweb after some hundred visits. The threads of a Python program seldom
    allocate at the same time. Other C libraries have neither such heaps nor this function.
    """
    with contextlib.suppress(AttributeError):
        mallopt = ctypes.CDLL(None).mallopt
        mallopt(_M_ARENA_MAX, 1)
        mallopt(_M_MMAP_THRESHOLD, LARGE)  # which does not grow any more
