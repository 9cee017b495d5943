"""Run a program in a child process, as a library may end it by C's exit(), past all of Python."""

import contextlib
import ctypes
import os
import signal
from collections.abc import Callable

ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_PR_SET_PDEATHSIG = 1  # of prctl(2)


def guarded(work: Callable[[], int], abrupt: Callable[[bool], int]) -> int:
    """Return the exit code of `work`, which runs in a child process.

    Signals that end a program go on to the child, which is in a process group of its own. Enter
    before there are threads. The child returns from here as well, with the same code.

    Args:
        abrupt: called if the child ends before `work` has returned, with whether such a signal has
            come; returns the exit code.
    """
    received: list[int] = []
    answer, result = os.pipe()
    parent = os.getpid()
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)  # until they are passed on
    child = os.fork()
    if not child:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        os.setpgid(0, 0)
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
        if os.getppid() != parent:  # it has ended before that
            os.kill(os.getpid(), signal.SIGTERM)
        code = work()
        os.write(result, bytes((code,)))
        return code
    os.close(result)

    def pass_on(number: int, _frame: object) -> None:
        received.append(number)
        with contextlib.suppress(ProcessLookupError):
            os.kill(child, number)

    before = {number: signal.signal(number, pass_on) for number in ENDING}
    signal.pthread_sigmask(signal.SIG_SETMASK, mask)
    try:
        answered = os.read(answer, 1)  # nothing if the child ends without it
        os.waitpid(child, 0)
    finally:
        os.close(answer)
        for number, handler in before.items():
            signal.signal(number, handler)
    return answered[0] if answered else abrupt(bool(received))
