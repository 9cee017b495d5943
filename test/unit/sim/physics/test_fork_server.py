"""Work in child processes: reports, ends of all kinds, and that no process is left."""

import contextlib
import errno
import math
import os
import resource
import signal
import socket
import subprocess
import sys
import threading
import time

import pytest

from rosbots_description.sim.physics import fork_server
from rosbots_description.sim.physics.fork_server import MAX_REPORT, Cancelled, ForkServer, Killed

ALLOWANCE = 20.0  # [s] never reached
SHORT = 0.3  # [s]
DEADLINE = 20.0  # [s]
PROMPT = 1.0  # [s] by which nobody is delayed
BUSY = 10  # processes that compute beside a test


@contextlib.contextmanager
def server_of(work):
    server = ForkServer(lambda: work, 'test')
    try:
        yield server
    finally:
        server.close()


def outcome(work, payload=b'', allowance=ALLOWANCE):
    """Return what a child reports that does `work`, or the code that it exits with."""
    with server_of(work) as server:
        try:
            return server.run(payload, allowance)
        except Killed as killed:
            return killed.exit_code


def burn(seconds):
    """Use up so much of this process's time on the processor."""
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass


def wait_until(condition):
    deadline = time.monotonic() + DEADLINE
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def is_there(process):
    with contextlib.suppress(FileNotFoundError), open(f'/proc/{process}/stat', 'rb') as file:
        return file.read().rpartition(b') ')[2][:1] != b'Z'
    return False


@pytest.fixture(name='busy')
def fixture_busy():
    """A machine of which others want more than there is."""
    others = [subprocess.Popen([sys.executable, '-c', 'while True: pass']) for _ in range(BUSY)]
    yield
    for other in others:
        other.kill()
        other.wait()


@pytest.fixture(autouse=True)
def fixture_nothing_is_left():
    before = os.listdir('/proc/self/fd')
    yield
    assert os.listdir('/proc/self/fd') == before


def test_a_child_reports_of_its_payload():
    assert outcome(lambda payload: payload.decode()[::-1], b'abc') == 'cba'


def test_a_payload_may_be_long_and_a_report_is_cut():
    assert outcome(lambda payload: payload.decode(), b'x' * 10_000_000) == 'x' * MAX_REPORT


def test_what_is_prepared_is_so_once_before_the_first_child():
    prepared = []

    def prepare():
        prepared.append(os.getpid())
        return lambda _: f'{prepared} {os.getppid()}'

    server = ForkServer(prepare, 'test')
    reports = {server.run(b'', ALLOWANCE) for _ in range(3)}
    server.close()
    (report,) = reports
    process = int(report.split()[1])
    assert report == f'[{process}] {process}'
    assert process != os.getpid()


@pytest.mark.parametrize('number', [signal.SIGSEGV, signal.SIGABRT, signal.SIGKILL])
def test_a_child_that_a_signal_ends_is_told_of(number):
    assert outcome(lambda _: os.kill(os.getpid(), number)) == -number


def test_a_child_that_ends_without_report_is_told_of():
    assert outcome(lambda _: os._exit(3)) == 3


def test_a_child_that_computes_for_ever_is_ended():
    assert outcome(lambda _: burn(math.inf), allowance=SHORT) == -signal.SIGPROF


def test_a_child_that_sleeps_for_ever_is_ended(monkeypatch):
    monkeypatch.setattr(fork_server, 'POLL_PERIOD', 0.02)
    assert outcome(lambda _: signal.pause()) == -signal.SIGALRM


def test_a_child_that_sleeps_for_a_while_is_not_ended(monkeypatch):
    monkeypatch.setattr(fork_server, 'POLL_PERIOD', 0.05)  # 1 s then is too long

    def work(_):
        for _ in range(3):
            time.sleep(0.5)
            burn(0.05)  # more than the system counts time by
        return 'done'

    assert outcome(work) == 'done'


@pytest.mark.usefixtures('busy')
def test_a_child_that_waits_for_a_processor_is_not_ended(monkeypatch):
    monkeypatch.setattr(fork_server, 'POLL_PERIOD', 0.005)  # 0.1 s of sleep would be too long

    def work(_):
        begin = time.monotonic()
        burn(1.0)
        return str(time.monotonic() - begin)

    assert float(outcome(work, allowance=1.5)) > 1.5  # though it took longer than that


def test_a_child_delays_nobody_elses():
    def work(payload):
        if payload == b'long':
            signal.pause()
        return 'done'

    with server_of(work) as server:
        unwanted = threading.Event()

        def begin():
            with contextlib.suppress(Cancelled):
                server.run(b'long', ALLOWANCE, lambda: not unwanted.is_set())

        others = [threading.Thread(target=begin) for _ in range(3)]
        for other in others:
            other.start()
        begin = time.monotonic()
        assert [server.run(b'', ALLOWANCE) for _ in range(3)] == ['done'] * 3
        assert time.monotonic() - begin < PROMPT
        assert all(other.is_alive() for other in others)
        unwanted.set()
        for other in others:
            other.join()


def test_a_child_that_nobody_waits_for_is_ended(tmp_path, monkeypatch):
    monkeypatch.setattr(fork_server, 'POLL_PERIOD', 0.05)
    note = tmp_path / 'note'

    def work(_):
        note.write_text(str(os.getpid()))
        signal.pause()

    with server_of(work) as server:
        with pytest.raises(Cancelled):
            server.run(b'', ALLOWANCE, lambda: not (note.exists() and note.read_text()))
        wait_until(lambda: not is_there(int(note.read_text())))
        assert server._channel.fileno() > 0  # it goes on without it


ABANDONED = """
import os, signal, sys
from rosbots_description.sim.physics.fork_server import ForkServer

def work(_):
    print(os.getppid(), os.getpid(), file=open(sys.argv[1], 'w'), flush=True)
    {does}

ForkServer(lambda: work, 'test').run(b'', 60.0)
"""


@pytest.mark.parametrize('does', ['signal.pause()', 'while True: pass'])
@pytest.mark.parametrize('victim', ['parent', 'server'])
def test_no_process_outlives_what_it_works_for(tmp_path, does, victim):
    note = tmp_path / 'note'
    environment = {**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)}
    parent = subprocess.Popen([sys.executable, '-c', ABANDONED.format(does=does), str(note)],
                              env=environment, stderr=subprocess.DEVNULL)
    try:
        wait_until(lambda: note.exists() and note.read_text().endswith('\n'))
        server, child = map(int, note.read_text().split())
        assert is_there(server)
        assert is_there(child)
        os.kill(parent.pid if victim == 'parent' else server, signal.SIGKILL)
        wait_until(lambda: not is_there(server) and not is_there(child))
    finally:
        parent.kill()
        parent.wait()


def test_ctrl_c_reaches_the_parent_only():
    def work(_):
        for number in (signal.SIGINT, signal.SIGTERM):
            os.kill(os.getppid(), number)
            os.kill(os.getpid(), number)
        return 'done'

    with server_of(work) as server:
        assert [server.run(b'', ALLOWANCE) for _ in range(2)] == ['done'] * 2


def test_no_connection_is_held_open():
    def work(_):
        return ' '.join(files(os.getpid()) + files(os.getppid()))

    def files(process):
        folder, names = f'/proc/{process}/fd', []
        for number in os.listdir(folder):
            with contextlib.suppress(FileNotFoundError):  # the listing's own is gone
                names.append(os.readlink(f'{folder}/{number}'))
        return names

    with contextlib.ExitStack() as stack:
        ends = [stack.enter_context(end) for end in socket.socketpair()]
        theirs = outcome(work).split()
        assert len(theirs) > 2 * len(ends)
        for end in ends:
            assert os.readlink(f'/proc/self/fd/{end.fileno()}') not in theirs


def test_where_no_process_can_be_made_the_system_is_named(monkeypatch):
    def prepare():
        def full():
            raise OSError(errno.EAGAIN, os.strerror(errno.EAGAIN))

        monkeypatch.setattr(fork_server.os, 'fork', full)
        return lambda _: 'done'

    server = ForkServer(prepare, 'test')
    for _ in range(2):
        with pytest.raises(BlockingIOError, match='Resource temporarily unavailable'):
            server.run(b'', ALLOWANCE)
    server.close()


def test_where_the_server_has_died_that_is_said():
    with server_of(lambda _: 'done') as server:
        os.kill(server._server, signal.SIGKILL)
        with pytest.raises(OSError, match='the fork server does not answer'):
            server.run(b'', ALLOWANCE)


def test_a_server_without_file_handles_says_so():
    def prepare():
        resource.setrlimit(resource.RLIMIT_NOFILE, (3, 3))
        return lambda _: 'done'

    server = ForkServer(prepare, 'test')
    with pytest.raises(OSError, match='the fork server does not answer'):
        server.run(b'', ALLOWANCE)
    server.close()
