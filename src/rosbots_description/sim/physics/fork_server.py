"""Run work that may crash in child processes.

The children are forked from a small server process, itself forked from this one before there were
threads, sockets and models: a fork of a threaded process can deadlock, and a fork of a big process
is slow. The fork server of `multiprocessing` imports everything anew, which takes 0.3 s and 25 MB.
"""

import contextlib
import ctypes
import errno
import faulthandler
import gc
import logging
import os
import resource
import selectors
import signal
import socket
import struct
import time
from collections.abc import Callable
from typing import NoReturn

Work = Callable[[bytes], str]

POLL_PERIOD = 0.5  # [s, wall] period of checking a child and its caller
# Consecutive checks at which a child may be asleep without having used any processor time. A
# process that waits for a processor or a disk is not asleep, however busy the machine is.
MAX_SLEEPING_POLLS = 20
MIN_POLLS = 10  # after which the caller is asked whether it still waits for the report

MAX_REPORT = 4096  # [bytes] for a report, allocated in advance in case memory runs out
_REQUEST = struct.Struct('d')  # allowance
_END = struct.Struct('?i')  # whether a child was created; its exit code, else errno
_PR_SET_PDEATHSIG, _PR_SET_NAME = 1, 15  # of <sys/prctl.h>
_SLEEPING = b'S'
_prctl = ctypes.CDLL(None).prctl
_TICK = 1.0 / os.sysconf('SC_CLK_TCK')  # [s]


class Killed(Exception):  # noqa: N818  not an error
    """A child ended without a report; `exit_code` as in `subprocess`."""

    def __init__(self, exit_code: int) -> None:
        super().__init__(exit_code)
        self.exit_code = exit_code


class Cancelled(Exception):  # noqa: N818  as above
    """The caller no longer wants the report; the child was killed."""


class ForkServer:
    """Creates child processes as copies of this process as it is now. Thread-safe."""

    def __init__(self, prepare: Callable[[], Work], name: str) -> None:
        """Fork the server process; do so before there are threads.

        Args:
            prepare: called once in the server process; returns the function that a child calls with
                its payload and whose result is the report.
            name: of the process and its children, as `top` shows it; at most 15 characters.
        """
        self._channel, theirs = socket.socketpair(type=socket.SOCK_SEQPACKET)
        self._server = os.fork()
        if not self._server:
            _run_server(prepare, theirs, name)
        theirs.close()

    def close(self) -> None:
        """End the server process and its children."""
        self._channel.close()
        if self._server:
            os.waitpid(self._server, 0)
            self._server = 0

    def run(
        self, payload: bytes, allowance: float, is_wanted: Callable[[], bool] = lambda: True
    ) -> str:
        """Return a child's report on a payload, at most `MAX_REPORT` bytes.

        Args:
            allowance: processor time [s] after which the child is killed by SIGPROF; one that
                sleeps for long is killed by SIGALRM.
            is_wanted: polled after 5 s and later; whether the report is still wanted.
        Raises:
            OSError: no child could be created.
            Killed: it ended without a report.
            Cancelled: `is_wanted` returned False.
        """
        caller, theirs = socket.socketpair(type=socket.SOCK_SEQPACKET)
        with caller, open(os.memfd_create('report'), 'w+b', buffering=0) as report:
            with theirs:
                os.posix_fallocate(report.fileno(), 0, MAX_REPORT + len(payload))
                os.pwrite(report.fileno(), payload, MAX_REPORT)
                try:
                    socket.send_fds(self._channel, [_REQUEST.pack(allowance)],
                                    [report.fileno(), theirs.fileno()])
                except ConnectionError:
                    raise _no_answer() from None
            caller.settimeout(POLL_PERIOD)
            exit_code = self._wait(caller, is_wanted)
            text = os.pread(report.fileno(), MAX_REPORT, 0).rstrip(b'\0').decode(errors='replace')
        if exit_code or not text:
            raise Killed(exit_code)
        return text

    def _wait(self, caller: socket.socket, is_wanted: Callable[[], bool]) -> int:
        """Return the exit code of a child."""
        answer, polls = None, 0
        while answer is None:
            try:
                answer = caller.recv(_END.size)
            except TimeoutError:
                polls += 1
                if polls >= MIN_POLLS and not is_wanted():
                    raise Cancelled from None
        if not answer:
            raise _no_answer()
        made, number = _END.unpack(answer)
        if not made:
            raise OSError(number, os.strerror(number))
        return int(number)


def _no_answer() -> OSError:
    return ChildProcessError(errno.ECHILD, 'the fork server does not answer')


class _Child:
    """A child process, as the server process sees it."""

    def __init__(self, process: int, caller: socket.socket, life: int) -> None:
        """Watch a process.

        Args:
            caller: socket that gets the result; the other end is closed if it is not wanted.
            life: a pipe that is closed when the process ends.
        """
        self._process, self.caller, self.life = process, caller, life
        self._sleeping_polls = 0  # in a row
        self._used = 0.0  # [s, processor] at the last look

    def kill(self, number: int = signal.SIGKILL) -> None:
        """Send it a signal; it remains a zombie until `end`."""
        os.kill(self._process, number)

    def end(self) -> None:
        """Send its exit code to the caller."""
        os.close(self.life)
        code = os.waitstatus_to_exitcode(os.waitpid(self._process, 0)[1])
        _answer(self.caller, True, code)

    def check_asleep(self) -> None:
        """Kill it if it has been asleep for too long."""
        with open(f'/proc/{self._process}/stat', 'rb') as file:
            state, *fields = file.read().rpartition(b') ')[2].split()
        used = _TICK * (int(fields[10]) + int(fields[11]))  # in user mode and in the kernel
        asleep = state == _SLEEPING and used == self._used
        self._sleeping_polls = self._sleeping_polls + 1 if asleep else 0
        self._used = used
        if self._sleeping_polls > MAX_SLEEPING_POLLS:
            self.kill(signal.SIGALRM)


def _answer(caller: socket.socket, made: bool, number: int) -> None:
    with caller, contextlib.suppress(OSError):  # it has gone
        caller.send(_END.pack(made, number))


def _run_server(prepare: Callable[[], Work], channel: socket.socket, name: str) -> NoReturn:
    """Serve requests until the channel is closed; the children die with this process."""
    try:
        _close_files(channel.fileno())
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)  # it ends with its parent
        _prctl(_PR_SET_NAME, name.encode())
        faulthandler.disable()
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))  # a crash leaves no file behind
        logging.disable()
        gc.freeze()
        gc.disable()  # the finalisers of the parent's objects must not run here
        _serve(prepare(), channel)
    finally:
        os._exit(0)


def _serve(work: Work, channel: socket.socket) -> None:
    children: set[_Child] = set()
    next_poll = 0.0
    with selectors.DefaultSelector() as selector:
        selector.register(channel, selectors.EVENT_READ)
        while True:
            for key, _ in selector.select(POLL_PERIOD if children else None):
                child = key.data
                if child is None:
                    request, files, _, _ = socket.recv_fds(channel, _REQUEST.size, 2)
                    if not request:
                        return
                    (allowance,) = _REQUEST.unpack(request)
                    child = _fork_child(work, allowance, files)
                    if child is not None:
                        children.add(child)
                        selector.register(child.caller, selectors.EVENT_READ, child)
                        selector.register(child.life, selectors.EVENT_READ, child)
                elif key.fd == child.life:
                    children.remove(child)
                    selector.unregister(child.life)
                    with contextlib.suppress(KeyError):  # its caller has gone
                        selector.unregister(child.caller)
                    child.end()
                elif child in children:  # its caller has gone
                    selector.unregister(child.caller)
                    child.kill()
            if time.monotonic() >= next_poll:
                next_poll = time.monotonic() + POLL_PERIOD
                for child in children:
                    child.check_asleep()


def _fork_child(work: Work, allowance: float, files: list[int]) -> _Child | None:
    """Return a child that works on a payload; None if none can be created.

    Args:
        files: one with the payload, which will hold the report, and the caller's socket.
    """
    if len(files) < 2:  # there are no file handles left
        for file in files:
            os.close(file)
        return None
    report, caller = files[0], socket.socket(fileno=files[1])
    parent = os.getpid()
    life = death = None
    try:
        life, death = os.pipe()
        process = os.fork()
        if not process:
            _run_child(work, allowance, report, death, parent)
        return _Child(process, caller, life)
    except OSError as error:
        if life is not None:
            os.close(life)
        _answer(caller, False, error.errno or errno.EIO)
        return None
    finally:
        os.close(report)
        if death is not None:
            os.close(death)


def _run_child(
    work: Work, allowance: float, report: int, death: int, parent: int
) -> NoReturn:
    """Process the payload and write the report; the end of this process closes `death`."""
    try:
        _prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:
            os._exit(1)  # the parent has ended already
        for number in (signal.SIGPROF, signal.SIGALRM):
            signal.signal(number, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_PROF, allowance)
        _close_files(report, death)
        with contextlib.suppress(OSError), open('/proc/self/oom_score_adj', 'w') as file:
            file.write('1000')  # if memory runs out, this process is to be killed first
        payload = os.pread(report, os.fstat(report).st_size - MAX_REPORT, MAX_REPORT)
        os.pwrite(report, work(payload).encode()[:MAX_REPORT], 0)
        os._exit(0)
    finally:
        os._exit(1)


def _close_files(*kept: int) -> None:
    """Discard all output, and close all inherited files, pipes and sockets but `kept`."""
    nowhere = os.open(os.devnull, os.O_RDWR)
    for number in range(3):
        os.dup2(nowhere, number)
    for number in map(int, os.listdir('/proc/self/fd')):
        if number > 2 and number not in kept:
            with contextlib.suppress(OSError):  # that of the directory listing
                os.close(number)
