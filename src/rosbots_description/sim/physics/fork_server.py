"""Run work that may crash in child processes.

The children are forked from a small server process, itself forked from this one before there were
threads, sockets and models: a fork of a threaded process can deadlock, and a fork of a big process
is slow. A server that has died is replaced by a new interpreter, which imports everything anew.

The fork server of `multiprocessing` always starts in that way: in 0.18 s of processor time and with
55 MB, here 0.01 s and 4 MB; its children take as long. And it does not notice one that is stopped.
"""

import contextlib
import ctypes
import errno
import faulthandler
import gc
import logging
import os
import pickle
import resource
import selectors
import signal
import socket
import struct
import sys
import threading
from collections.abc import Callable
from typing import NamedTuple, NoReturn

from ..core import POLL_PERIOD, Fault, ProcessWatch, report

Work = Callable[[bytes], str]

MIN_POLLS = 10  # after which the caller is asked whether it still waits for the report

MAX_REPORT = 4096  # [bytes] for a report, allocated in advance in case memory runs out
_REQUEST = struct.Struct('d')  # allowance
_ANSWER = struct.Struct('i')  # first the number of the child, or -errno; then its exit code
_PR_SET_PDEATHSIG, _PR_SET_NAME = 1, 15  # of <sys/prctl.h>
_prctl = ctypes.CDLL(None).prctl
# A new server process: the search path of this one, and the channel in place of standard input.
_PROGRAM = f"""
import sys
sys.path[:] = sys.argv[1:]
from {__name__} import serve_standard_input
serve_standard_input()
"""


class Killed(Exception):  # noqa: N818  not an error
    """A child ended without a report; `exit_code` as in `subprocess`."""

    def __init__(self, exit_code: int) -> None:
        super().__init__(exit_code)
        self.exit_code = exit_code


class Cancelled(Exception):  # noqa: N818  as above
    """The caller no longer wants the report; the child was killed."""


class ServerEndedError(ChildProcessError):
    """The server process ended before it had an answer."""

    def __init__(self) -> None:
        super().__init__(errno.ECHILD, 'the fork server does not answer')


class ForkServer:
    """Creates child processes as copies of this process as it is now. Thread-safe.

    A server process that ends, or is stopped, is replaced when it is used next.
    """

    def __init__(
        self, prepare: Callable[[], Work], name: str, replacement: Callable[[], Work] | None = None
    ) -> None:
        """Fork the server process; do so before there are threads.

        Args:
            prepare: called once in the server process; returns the function that a child calls with
                its payload and whose result is the report.
            name: of the process and its children, as `top` shows it; at most 15 characters.
            replacement: replaces `prepare` in a later server process, where nothing of this one
                exists; it is sent by pickle. None: a server that has ended is not replaced.
        """
        self._name, self._replacement = name, replacement
        ours, theirs = socket.socketpair(type=socket.SOCK_SEQPACKET)
        process = os.fork()
        if not process:
            _run_server(prepare, theirs, name)
        theirs.close()
        self._lock = threading.Lock()  # of replacing the server
        self._server = _Server(process, ours)

    def close(self) -> None:
        """End the server process and its children."""
        with self._lock:
            self._replacement = None
            self._server.end()

    def run(
        self, payload: bytes, allowance: float, is_wanted: Callable[[], bool] = lambda: True
    ) -> str:
        """Return a child's report on a payload, at most `MAX_REPORT` bytes.

        Args:
            allowance: processor time [s] after which the child is killed by SIGPROF; one that
                sleeps for long is killed, too, with the exit code of SIGALRM.
            is_wanted: polled after 5 s and later; whether the report is still wanted.
        Raises:
            OSError: no child could be created.
            Killed: it ended without a report.
            Cancelled: `is_wanted` returned False.
        """
        server = self._server
        try:
            return server.run(payload, allowance, is_wanted)
        except ServerEndedError:
            self._replace(server)
        return self._server.run(payload, allowance, is_wanted)

    def _replace(self, ended: '_Server') -> None:
        """Replace a server process, unless another thread has done so.

        Raises:
            ServerEndedError: there is no replacement for it.
            OSError: no process could be created.
        """
        with self._lock:
            if self._server is not ended:
                return
            code = ended.end()
            if self._replacement is None:
                raise ServerEndedError from None
            how = f'killed by signal {-code}' if code < 0 else f'exit code {code}'
            report(Fault(f'the process {self._name} has ended ({how}); it is started again'))
            ours, theirs = socket.socketpair(type=socket.SOCK_SEQPACKET)
            with theirs:
                ours.send(pickle.dumps((self._replacement, self._name)))
                process = os.posix_spawn(
                    sys.executable,
                    [sys.executable, '-P', '-c', _PROGRAM, *sys.path],
                    os.environ,
                    file_actions=[(os.POSIX_SPAWN_DUP2, theirs.fileno(), 0)],
                )
            self._server = _Server(process, ours)


class _Server:
    """A server process, and the channel to it."""

    def __init__(self, process: int, channel: socket.socket) -> None:
        self.process, self.channel = process, channel
        self._lock = threading.Lock()  # the process exists, and the channel is open
        self._exit_code: int | None = None

    def end(self) -> int:
        """End the process with its children; return its exit code."""
        with self._lock:
            if self._exit_code is None:
                self.channel.close()
                os.kill(self.process, signal.SIGKILL)  # a stopped process does not end otherwise
                self._exit_code = os.waitstatus_to_exitcode(os.waitpid(self.process, 0)[1])
            return self._exit_code

    def run(self, payload: bytes, allowance: float, is_wanted: Callable[[], bool]) -> str:
        """Return the report of a child; arguments and errors as of `ForkServer.run`."""
        caller, theirs = socket.socketpair(type=socket.SOCK_SEQPACKET)
        with caller, open(os.memfd_create('report'), 'w+b', buffering=0) as report:
            with theirs:
                os.posix_fallocate(report.fileno(), 0, MAX_REPORT + len(payload))
                os.pwrite(report.fileno(), payload, MAX_REPORT)
                self._send(_REQUEST.pack(allowance), [report.fileno(), theirs.fileno()])
            caller.settimeout(POLL_PERIOD)
            exit_code = self._wait(caller, is_wanted)
            text = os.pread(report.fileno(), MAX_REPORT, 0).rstrip(b'\0').decode(errors='replace')
        if exit_code or not text:
            raise Killed(exit_code)
        return text

    def _send(self, request: bytes, files: list[int]) -> None:
        with self._lock:
            if self._exit_code is not None:
                raise ServerEndedError
            try:
                socket.send_fds(self.channel, [request], files)
            except ConnectionError:
                raise ServerEndedError from None

    def _wait(self, caller: socket.socket, is_wanted: Callable[[], bool]) -> int:
        """Return the exit code of a child. When `caller` is closed before, the child is killed."""
        polls, server, child = 0, ProcessWatch(self.process), None
        while True:
            try:
                answer = caller.recv(_ANSWER.size)
            except TimeoutError:
                polls += 1
                if polls >= MIN_POLLS and not is_wanted():
                    raise Cancelled from None
                self._require_running(server)
                if child is not None and _is_hung(child):
                    raise Killed(-signal.SIGALRM) from None
                continue
            if not answer:
                raise ServerEndedError
            number = int(_ANSWER.unpack(answer)[0])
            if child is not None:
                return number
            if number < 0:
                raise OSError(-number, os.strerror(-number))
            child = ProcessWatch(number)

    def _require_running(self, watch: ProcessWatch) -> None:
        with self._lock:
            if self._exit_code is not None or watch.is_stopped():
                raise ServerEndedError


def _is_hung(child: ProcessWatch) -> bool:
    try:
        return child.is_hung()
    except (FileNotFoundError, ProcessLookupError):  # it has ended just now
        return False


class _Child(NamedTuple):
    """A child process, as the server process sees it."""

    process: int  # a zombie until it is removed
    caller: socket.socket  # gets the answers; the other end is closed if they are not wanted
    life: int  # a pipe that is closed when the process ends


def _answer(caller: socket.socket, number: int) -> None:
    with contextlib.suppress(OSError):  # it has gone
        caller.send(_ANSWER.pack(number))


def serve_standard_input() -> NoReturn:
    """Be the server process, with its channel as standard input."""
    channel = socket.socket(fileno=os.dup(0))
    prepare, name = pickle.loads(channel.recv(MAX_REPORT))
    _run_server(prepare, channel, name)


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
    with selectors.DefaultSelector() as selector:
        selector.register(channel, selectors.EVENT_READ)
        while True:
            for key, _ in selector.select():
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
                    os.close(child.life)
                    code = os.waitstatus_to_exitcode(os.waitpid(child.process, 0)[1])
                    with child.caller:
                        _answer(child.caller, code)
                elif child in children:  # its caller has gone
                    selector.unregister(child.caller)
                    os.kill(child.process, signal.SIGKILL)


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
        _answer(caller, process)
        return _Child(process, caller, life)
    except OSError as error:
        if life is not None:
            os.close(life)
        with caller:
            _answer(caller, -(error.errno or errno.EIO))
        return None
    finally:
        os.close(report)
        if death is not None:
            os.close(death)


def _run_child(work: Work, allowance: float, report: int, death: int, parent: int) -> NoReturn:
    """Process the payload and write the report; the end of this process closes `death`."""
    try:
        _prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:
            os._exit(1)  # the parent has ended already
        signal.signal(signal.SIGPROF, signal.SIG_DFL)
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
