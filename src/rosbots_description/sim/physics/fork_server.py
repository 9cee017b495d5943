"""Work in child processes that may die of it.

The children are made by a small process, which is a copy of this one from before it had threads,
sockets and models: a fork of many threads can find a lock held for ever, and one of a big process
takes long. The library's own fork server imports everything anew, which takes 0.3 s and 25 MB.
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

LOOK = 0.5  # [s, wall] between two looks at a child and its caller
# Looks in a row at which a child may sleep without having computed anything since the one before.
# What waits for a processor or a disk does not sleep, however busy the machine is.
MAX_ASLEEP = 20
LOOKS_UNASKED = 10  # after which the caller is asked whether it still waits

ROOM = 4096  # [bytes] for a report, set aside before, so that a full machine cannot silence a child
_REQUEST = struct.Struct('d')  # allowance
_END = struct.Struct('?i')  # whether there was a child; its exit code, or else errno
_PR_SET_PDEATHSIG, _PR_SET_NAME = 1, 15  # of <sys/prctl.h>
_SLEEPING = b'S'
_prctl = ctypes.CDLL(None).prctl
_TICK = 1.0 / os.sysconf('SC_CLK_TCK')  # [s]


class Killed(Exception):  # noqa: N818  no error of ours
    """A child ended without a report: `exit_code` is as that of `subprocess`."""

    def __init__(self, exit_code: int) -> None:
        super().__init__(exit_code)
        self.exit_code = exit_code


class Unwanted(Exception):  # noqa: N818  as above
    """Nobody waits for the report any more; the child was ended."""


class ForkServer:
    """Makes child processes of this process as it is now. Any thread may use it."""

    def __init__(self, prepare: Callable[[], Work], name: str) -> None:
        """Fork the small process; do so before there are threads.

        Args:
            prepare: runs once in the small process and returns what its children do with each
                payload; what that returns is the report.
            name: of the process and its children, as `top` shows it; of 15 characters.
        """
        self._channel, theirs = socket.socketpair(type=socket.SOCK_SEQPACKET)
        self._server = os.fork()
        if not self._server:
            _be_the_server(prepare, theirs, name)
        theirs.close()

    def close(self) -> None:
        """End the small process and its children."""
        self._channel.close()
        if self._server:
            os.waitpid(self._server, 0)
            self._server = 0

    def run(
        self, payload: bytes, allowance: float, is_wanted: Callable[[], bool] = lambda: True
    ) -> str:
        """Return what a child reports of a payload, at most `ROOM` bytes of it.

        Args:
            allowance: processor time [s] after which the child is ended by SIGPROF; one that
                sleeps for long is ended by SIGALRM.
            is_wanted: asked now and then, from 5 s on, whether the report is still wanted.
        Raises:
            OSError: no child could be made.
            Killed: it ended without a report.
            Unwanted: `is_wanted` said no.
        """
        caller, theirs = socket.socketpair(type=socket.SOCK_SEQPACKET)
        with caller, open(os.memfd_create('report'), 'w+b', buffering=0) as report:
            with theirs:
                os.posix_fallocate(report.fileno(), 0, ROOM + len(payload))
                os.pwrite(report.fileno(), payload, ROOM)
                try:
                    socket.send_fds(self._channel, [_REQUEST.pack(allowance)],
                                    [report.fileno(), theirs.fileno()])
                except ConnectionError:
                    raise _no_answer() from None
            caller.settimeout(LOOK)
            exit_code = self._wait(caller, is_wanted)
            text = os.pread(report.fileno(), ROOM, 0).rstrip(b'\0').decode(errors='replace')
        if exit_code or not text:
            raise Killed(exit_code)
        return text

    def _wait(self, caller: socket.socket, is_wanted: Callable[[], bool]) -> int:
        """Return the exit code of a child."""
        answer, looks = None, 0
        while answer is None:
            try:
                answer = caller.recv(_END.size)
            except TimeoutError:
                looks += 1
                if looks >= LOOKS_UNASKED and not is_wanted():
                    raise Unwanted from None
        if not answer:
            raise _no_answer()
        made, number = _END.unpack(answer)
        if not made:
            raise OSError(number, os.strerror(number))
        return int(number)


def _no_answer() -> OSError:
    return ChildProcessError(errno.ECHILD, 'the process that makes others does not answer')


class _Child:
    """A child process, as the small process sees it."""

    def __init__(self, process: int, caller: socket.socket, life: int) -> None:
        """Watch a process.

        Args:
            caller: who is told of its end; closed at the other side by who no longer wants it.
            life: a pipe that ends when it does.
        """
        self._process, self.caller, self.life = process, caller, life
        self._looks_asleep = 0  # in a row
        self._used = 0.0  # [s, processor] at the last look

    def kill(self, number: int = signal.SIGKILL) -> None:
        """Let it end; it is there until `end`."""
        os.kill(self._process, number)

    def end(self) -> None:
        """Tell the caller how it has ended."""
        os.close(self.life)
        code = os.waitstatus_to_exitcode(os.waitpid(self._process, 0)[1])
        _answer(self.caller, True, code)

    def look(self) -> None:
        """Kill it if it sleeps for ever."""
        with open(f'/proc/{self._process}/stat', 'rb') as file:
            state, *fields = file.read().rpartition(b') ')[2].split()
        used = _TICK * (int(fields[10]) + int(fields[11]))  # in user mode and in the kernel
        asleep = state == _SLEEPING and used == self._used
        self._looks_asleep = self._looks_asleep + 1 if asleep else 0
        self._used = used
        if self._looks_asleep > MAX_ASLEEP:
            self.kill(signal.SIGALRM)


def _answer(caller: socket.socket, made: bool, number: int) -> None:
    with caller, contextlib.suppress(OSError):  # it has gone
        caller.send(_END.pack(made, number))


def _be_the_server(prepare: Callable[[], Work], channel: socket.socket, name: str) -> NoReturn:
    """Make children until nobody can ask for them any more; they die with this process."""
    try:
        _leave_files(channel.fileno())
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)  # it ends with its parent, a child by itself
        _prctl(_PR_SET_NAME, name.encode())
        faulthandler.disable()
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))  # a crash leaves no file behind
        logging.disable()
        gc.freeze()
        gc.disable()  # what the parent's objects do at their end is not for us to do
        _serve(prepare(), channel)
    finally:
        os._exit(0)


def _serve(work: Work, channel: socket.socket) -> None:
    children: set[_Child] = set()
    next_look = 0.0
    with selectors.DefaultSelector() as selector:
        selector.register(channel, selectors.EVENT_READ)
        while True:
            for key, _ in selector.select(LOOK if children else None):
                child = key.data
                if child is None:
                    request, files, _, _ = socket.recv_fds(channel, _REQUEST.size, 2)
                    if not request:
                        return
                    (allowance,) = _REQUEST.unpack(request)
                    child = _make_child(work, allowance, files)
                    if child is not None:
                        children.add(child)
                        selector.register(child.caller, selectors.EVENT_READ, child)
                        selector.register(child.life, selectors.EVENT_READ, child)
                elif key.fd == child.life:
                    children.remove(child)
                    selector.unregister(child.life)
                    with contextlib.suppress(KeyError):  # its caller had gone
                        selector.unregister(child.caller)
                    child.end()
                elif child in children:  # its caller has gone
                    selector.unregister(child.caller)
                    child.kill()
            if time.monotonic() >= next_look:
                next_look = time.monotonic() + LOOK
                for child in children:
                    child.look()


def _make_child(work: Work, allowance: float, files: list[int]) -> _Child | None:
    """Return a child that works on a payload; None if none can be made.

    Args:
        files: one that holds the payload and is to hold the report, and the caller's socket.
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
            _be_the_child(work, allowance, report, death, parent)
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


def _be_the_child(
    work: Work, allowance: float, report: int, death: int, parent: int
) -> NoReturn:
    """Work on the payload and write the report; `death` is closed by the end of the process."""
    try:
        _prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:
            os._exit(1)  # it was gone before
        for number in (signal.SIGPROF, signal.SIGALRM):
            signal.signal(number, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_PROF, allowance)
        _leave_files(report, death)
        with contextlib.suppress(OSError), open('/proc/self/oom_score_adj', 'w') as file:
            file.write('1000')  # where memory runs out, this one is to go first
        payload = os.pread(report, os.fstat(report).st_size - ROOM, ROOM)
        os.pwrite(report, work(payload).encode()[:ROOM], 0)
        os._exit(0)
    finally:
        os._exit(1)


def _leave_files(*kept: int) -> None:
    """Print nowhere, and keep no file, pipe or connection open that somebody else closes."""
    nowhere = os.open(os.devnull, os.O_RDWR)
    for number in range(3):
        os.dup2(nowhere, number)
    for number in map(int, os.listdir('/proc/self/fd')):
        if number > 2 and number not in kept:
            with contextlib.suppress(OSError):  # the listing's own is gone
                os.close(number)
