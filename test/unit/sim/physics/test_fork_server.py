"""Work in child processes: reports, all kinds of exits, and no process left behind."""

import contextlib
import errno
import math
import operator
import os
import resource
import signal
import socket
import subprocess
import sys
import threading
import time
from functools import partial

import pytest
from support import burn
from support.patience import wait_until
from support.programs import is_running

from rosbots_description.sim.physics import fork_server
from rosbots_description.sim.physics.fork_server import MAX_REPORT, Cancelled, ForkServer, Killed

ALLOWANCE = 20.0  # [s] never reached
SHORT = 0.3  # [s]
BUSY = 10  # busy processes beside a test, on the same processor


def server_of(work):
    return contextlib.closing(ForkServer(lambda: work, 'test'))


def outcome(work, payload=b'', allowance=ALLOWANCE):
    """Return the report of a child that does `work`, or its exit code."""
    with server_of(work) as server:
        try:
            return server.run(payload, allowance)
        except Killed as killed:
            return killed.exit_code


@pytest.fixture(name='busy')
def fixture_busy():
    """Run the test on one overloaded processor."""
    processors = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(processors)})
    others = [subprocess.Popen([sys.executable, '-c', 'while True: pass']) for _ in range(BUSY)]
    yield
    for other in others:
        other.kill()
        other.wait()
    os.sched_setaffinity(0, processors)


@pytest.fixture(autouse=True)
def fixture_nothing_is_left(no_collection):
    before = os.listdir('/proc/self/fd')
    yield
    assert os.listdir('/proc/self/fd') == before


def test_child_gets_its_payload_and_reports():
    assert outcome(lambda payload: payload.decode()[::-1], b'abc') == 'cba'


def test_long_payload_is_passed_and_long_report_is_truncated():
    assert outcome(lambda payload: payload.decode(), b'x' * 10_000_000) == 'x' * MAX_REPORT


def test_preparation_runs_once_before_the_first_child():
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
def test_child_killed_by_a_signal_is_reported(number):
    assert outcome(lambda _: os.kill(os.getpid(), number)) == -number


def test_child_that_exits_without_report_is_reported():
    assert outcome(lambda _: os._exit(3)) == 3


def test_child_in_an_endless_loop_is_killed():
    assert outcome(lambda _: burn(math.inf), allowance=SHORT) == -signal.SIGPROF


@pytest.mark.parametrize(
    'sleep', [signal.pause, lambda: os.kill(os.getpid(), signal.SIGSTOP)], ids=['asleep', 'stopped']
)
def test_child_that_sleeps_forever_is_killed(sleep, monkeypatch):
    monkeypatch.setattr(fork_server, 'POLL_PERIOD', 0.02)
    assert outcome(lambda _: sleep()) == -signal.SIGALRM


def test_child_that_sleeps_for_a_while_is_not_killed(monkeypatch):
    monkeypatch.setattr(fork_server, 'POLL_PERIOD', 0.05)  # 1 s then is too long

    def work(_):
        for _ in range(3):
            time.sleep(0.5)
            burn(0.05)  # more than a tick of the system's clock
        return 'done'

    assert outcome(work) == 'done'


@pytest.mark.usefixtures('busy')
def test_child_that_waits_for_a_processor_is_not_killed(monkeypatch):
    monkeypatch.setattr(fork_server, 'POLL_PERIOD', 0.005)  # 0.1 s of sleep would be too long

    def work(_):
        begin = time.monotonic()
        burn(0.1)
        return str(time.monotonic() - begin)

    assert float(outcome(work, allowance=0.2)) > 0.2  # in spite of a longer wall time


def test_child_does_not_delay_others():
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
        assert [server.run(b'', ALLOWANCE) for _ in range(3)] == ['done'] * 3
        assert all(other.is_alive() for other in others)
        unwanted.set()
        for other in others:
            other.join()


def test_child_without_a_waiting_caller_is_killed(tmp_path, monkeypatch):
    monkeypatch.setattr(fork_server, 'POLL_PERIOD', 0.05)
    note = tmp_path / 'note'

    def work(_):
        note.write_text(str(os.getpid()))
        signal.pause()

    with server_of(work) as server:
        with pytest.raises(Cancelled):
            server.run(b'', ALLOWANCE, lambda: not (note.exists() and note.read_text()))
        wait_until(lambda: not is_running(int(note.read_text())))
        assert server._server.channel.fileno() > 0  # the server continues


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
def test_processes_end_with_their_parent(tmp_path, does, victim):
    note = tmp_path / 'note'
    environment = {**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)}
    parent = subprocess.Popen(
        [sys.executable, '-c', ABANDONED.format(does=does), str(note)],
        env=environment,
        stderr=subprocess.DEVNULL,
    )
    try:
        wait_until(lambda: note.exists() and note.read_text().endswith('\n'))
        server, child = map(int, note.read_text().split())
        assert is_running(server)
        assert is_running(child)
        os.kill(parent.pid if victim == 'parent' else server, signal.SIGKILL)
        wait_until(lambda: not is_running(server) and not is_running(child))
    finally:
        parent.kill()
        parent.wait()


def test_ctrl_c_ends_the_parent_only():
    def work(_):
        for number in (signal.SIGINT, signal.SIGTERM):
            os.kill(os.getppid(), number)
            os.kill(os.getpid(), number)
        return 'done'

    with server_of(work) as server:
        assert [server.run(b'', ALLOWANCE) for _ in range(2)] == ['done'] * 2


def test_child_inherits_no_open_connection():
    def work(_):
        return ' '.join(files(os.getpid()) + files(os.getppid()))

    def files(process):
        folder, names = f'/proc/{process}/fd', []
        for number in os.listdir(folder):
            with contextlib.suppress(FileNotFoundError):  # that of the listing itself
                names.append(os.readlink(f'{folder}/{number}'))
        return names

    with contextlib.ExitStack() as stack:
        ends = [stack.enter_context(end) for end in socket.socketpair()]
        theirs = outcome(work).split()
        assert len(theirs) > 2 * len(ends)
        for end in ends:
            assert os.readlink(f'/proc/self/fd/{end.fileno()}') not in theirs


def test_failing_fork_raises_the_error_of_the_system(monkeypatch):
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


# Prepares work that decodes its payload; a replacing process finds it by its name.
DECODING = partial(operator.methodcaller, 'decode')


@pytest.fixture(name='server')
def fixture_server():
    with contextlib.closing(ForkServer(DECODING, 'test', DECODING)) as server:
        yield server


@pytest.mark.parametrize('number', [signal.SIGKILL, signal.SIGSEGV])
def test_dead_server_is_replaced_and_no_zombie_remains(server, number, caplog):
    for times in (1, 2):
        dead = server._server.process
        os.kill(dead, number)
        assert server.run(b'world', ALLOWANCE) == 'world'
        assert not os.path.exists(f'/proc/{dead}')
        assert caplog.messages == times * [
            f'the process test has ended (killed by signal {number}); it is started again'
        ]


def test_server_killed_under_many_callers_is_replaced_once(server, caplog):
    os.kill(server._server.process, signal.SIGSTOP)  # so that all of them wait
    reports = []
    callers = [
        threading.Thread(target=lambda: reports.append(server.run(b'all', ALLOWANCE)))
        for _ in range(8)
    ]
    for caller in callers:
        caller.start()
    os.kill(server._server.process, signal.SIGKILL)
    for caller in callers:
        caller.join()
    assert reports == ['all'] * len(callers)
    assert len(caplog.messages) == 1


def test_stopped_server_is_replaced(server, monkeypatch):
    monkeypatch.setattr(fork_server, 'POLL_PERIOD', 0.02)
    stopped = server._server.process
    os.kill(stopped, signal.SIGSTOP)
    assert server.run(b'world', ALLOWANCE) == 'world'
    assert not os.path.exists(f'/proc/{stopped}')


def test_stopped_server_ends_with_its_owner(server):
    os.kill(server._server.process, signal.SIGSTOP)


def test_replacing_server_reads_no_module_of_the_working_folder(server, tmp_path, monkeypatch):
    for name in ('pickle', 'socket', 'numpy', 'os'):
        (tmp_path / f'{name}.py').write_text(f"open('{tmp_path}/harm', 'w')")
    monkeypatch.chdir(tmp_path)
    os.kill(server._server.process, signal.SIGKILL)
    assert server.run(b'world', ALLOWANCE) == 'world'
    assert not (tmp_path / 'harm').exists()


def test_dead_server_without_a_replacement_is_reported():
    with server_of(lambda _: 'done') as server:
        os.kill(server._server.process, signal.SIGKILL)
        with pytest.raises(OSError, match='the fork server does not answer'):
            server.run(b'', ALLOWANCE)


def test_server_out_of_file_descriptors_is_reported():
    def prepare():
        resource.setrlimit(resource.RLIMIT_NOFILE, (3, 3))
        return lambda _: 'done'

    server = ForkServer(prepare, 'test')
    with pytest.raises(OSError, match='the fork server does not answer'):
        server.run(b'', ALLOWANCE)
    server.close()
