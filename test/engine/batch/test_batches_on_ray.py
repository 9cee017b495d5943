"""Batches on Ray: the same rows whatever the workers, and nothing lost with those that die."""

import multiprocessing
import os
import signal
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import pytest
import yaml
from pyarrow import parquet
from support.batches import pushed_ball
from support.listening import listening
from support.patience import wait_until
from support.ray_machines import run_on_several_machines

from rosbots_description.batch import ClusterError, cluster, run
from rosbots_description.cli.launched import descendants

pytest.importorskip('ray')
LOOPBACK = '0100007F'  # in /proc/net/tcp; ::ffff:127.0.0.1 ends so, too
PATIENCE = 300.0  # [s, wall] for what takes a few; only ends a hopeless wait
# Ends processes at a defined moment: in the middle of a run, at the first attempt or at each.
MORTAL = """
import os, signal
from pathlib import Path

def make(run):
    mark = Path(__file__).with_name(f'{{run.number}} ended')
    def act(time, readings):
        if time > 0.4 and (run.number in {always} or run.number in {once} and not mark.exists()):
            mark.touch()
            for victim in {victims}:
                os.kill(victim, signal.SIGKILL)
    return act
"""


def scenario(folder, once=(), always=(), victims='[os.getpid()]'):
    """Return a scenario of twenty runs, of which some kill `victims`, by default their worker."""
    (folder / 'policy.py').write_text(MORTAL.format(once=once, always=always, victims=victims))
    return pushed_ball(
        policy=f'{folder / "policy.py"}:make',
        repeat=10,
        seed=3,
        parameters={'force': {'grid': [0.5, 3.0]}, 'start': {'uniform': [0.0, 1.0]}},
        models=[{**pushed_ball()['models'][0], 'pose': {'x': '$start', 'z': 5.0}}],
        conditions=['x_end - start > 0.5'],
    )


@pytest.fixture(autouse=True)
def scratch(tmp_path_factory, monkeypatch):
    """Assert that Ray leaves no folder behind; other batches have theirs elsewhere."""
    tmp_path_factory.getbasetemp()  # which outlasts the place of this test
    with tempfile.TemporaryDirectory(prefix='t', dir='/tmp') as place:  # short: for Ray's sockets
        monkeypatch.setattr(tempfile, 'tempdir', place)
        monkeypatch.setenv('TMPDIR', place)
        # Ray's workers are nice by 15: beside other tests they would stand still.
        monkeypatch.setenv('RAY_worker_niceness', '0')
        yield
        assert list(Path(place).glob('rb*')) == []


def test_lost_workers_lose_no_run_but_those_that_always_end_them(tmp_path, monkeypatch, capfd):
    monkeypatch.setattr(cluster, 'ATTEMPTS', 3)  # each starts a worker
    expected = run(scenario(tmp_path), workers=0).table.to_pylist()
    ours, addresses = os.getpid(), set()

    def look(done, _total, _repeated):
        if done == 1:
            addresses.update(address for address, _ in listening(descendants(ours)))

    made = run(scenario(tmp_path, once=[3, 7], always=[12]), workers=2, progress=look)
    rows = made.table.to_pylist()
    assert made.outcomes == {'passed': 9, 'failed': 10, 'error': 1}
    assert rows[12]['reason'] == f'the worker ended in each of {cluster.ATTEMPTS} attempts'
    assert made.repeated == 2 + cluster.ATTEMPTS - 1
    assert rows[:12] + rows[13:] == expected[:12] + expected[13:]
    assert addresses
    assert all(address.endswith(LOOPBACK) for address in addresses)
    assert capfd.readouterr() == ('', '')


def test_messages_of_ray_stay_off_the_console_from_connecting_to_the_end(monkeypatch, capfd):
    import ray
    from ray._private import worker

    def report(*_arguments, **_options):
        worker.print_to_stdstream(
            {'lines': ['a worker died'], 'pid': 'raylet', 'is_err': False}, ignore_prefix=False
        )

    monkeypatch.setattr(ray, 'init', report)
    monkeypatch.setattr(ray, 'shutdown', report)
    with cluster._session(ray, address='local'):
        report()
    assert capfd.readouterr() == ('', '')
    report()
    assert 'a worker died' in capfd.readouterr().out


def test_a_lost_machine_of_several_loses_no_run(tmp_path):
    expected = run(scenario(tmp_path), workers=0).table
    all_of_it = '[os.getppid(), os.getpid()]'  # what Ray has there, and the worker
    doomed = scenario(tmp_path, once=[7], victims=all_of_it)
    with ProcessPoolExecutor(1, multiprocessing.get_context('spawn')) as alone:
        made = alone.submit(run_on_several_machines, doomed).result(PATIENCE)
    assert made.repeated >= 1
    assert made.table.equals(expected)


@contextmanager
def endless_command(folder):
    """Start a command that makes runs for ever; yield its process when there are rows."""
    path = folder / 'endless.yaml'
    path.write_text(yaml.safe_dump(scenario(folder) | {'repeat': 5000}))

    def has_rows():
        return list(folder.glob('rows/rows/*.parquet'))

    command = subprocess.Popen(
        [
            sys.executable,
            '-m',
            'rosbots_description.cli.batch',
            str(path),
            '--workers',
            '1',
            '--output',
            str(folder / 'rows'),
        ],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {'PYTHONPATH': os.pathsep.join(sys.path)},
    )
    try:
        wait_until(lambda: has_rows() or command.poll() is not None, 'rows', PATIENCE)
        assert has_rows(), command.communicate()
        yield command
    finally:
        command.kill()


def test_an_interrupted_command_leaves_its_rows_and_no_process(tmp_path):
    with endless_command(tmp_path) as command:
        processes = descendants(command.pid)
        assert processes
        command.send_signal(signal.SIGTERM)
        printed, said = command.communicate(timeout=PATIENCE)
    assert (command.returncode, printed) == (130, ''), said
    rows = parquet.read_table(tmp_path / 'rows' / 'rows').num_rows
    assert said == (
        f'batch: interrupted; {rows} rows are in {tmp_path / "rows"}, and the same '
        'command makes the others\n'
    )
    wait_until(
        lambda: not any(Path(f'/proc/{one}').exists() for one in processes),
        'the end of its processes',
        PATIENCE,
    )


def test_a_batch_whose_ray_is_killed_ends_with_one_sentence(tmp_path):
    with endless_command(tmp_path) as command:
        victims = [
            one
            for one in descendants(command.pid)
            if 'raylet/raylet' in Path(f'/proc/{one}/cmdline').read_text()
        ]
        assert victims
        for victim in victims:
            os.kill(victim, signal.SIGKILL)
        printed, said = command.communicate(timeout=PATIENCE)
    assert command.returncode != 0
    assert (printed, said) == (
        '',
        (
            'batch: ended by Ray, of which a process has died, or by a signal; the rows so far are '
            'kept, and the same command makes the others\n'
        ),
    )
    assert parquet.read_table(tmp_path / 'rows' / 'rows').num_rows


@pytest.mark.parametrize(
    ('arguments', 'said'),
    [
        ({'workers': -1}, 'workers takes at least 1, or 0 for none'),
        ({'workers': 2, 'address': 'auto'}, 'only without an address'),
        ({'address': '127.0.0.1:1'}, "no Ray cluster at '127.0.0.1:1': "),
    ],
)
def test_a_cluster_that_is_not_there_is_named(arguments, said):
    with pytest.raises(ClusterError, match=said):
        run(pushed_ball(), **arguments)


def test_without_ray_one_sentence_says_what_to_do(monkeypatch):
    monkeypatch.setitem(sys.modules, 'ray', None)
    with pytest.raises(ClusterError, match='the Python package ray is not installed'):
        run(pushed_ball(), workers=2)
