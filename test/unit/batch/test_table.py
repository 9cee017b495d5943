"""Rows in files: complete at any time, kept, in order, and no worse for a full disk."""

import contextlib
import errno
import os
import subprocess
import sys
import threading

import pytest
from pyarrow import parquet
from support.batches import full_disk, pushed_ball

from rosbots_description.batch import ScenarioError, ScenarioFile, run
from rosbots_description.batch.simulation import empty_row
from rosbots_description.batch.table import Table


@pytest.fixture
def file():
    return ScenarioFile(
        pushed_ball(parameters={'force': {'grid': [float(number) for number in range(50)]}})
    )


def rows(file, *numbers):
    return [
        {**empty_row(file, file.parameters.run(number)), 'outcome': 'passed', 'x_end': 1.5}
        for number in numbers
    ]


def test_flushed_rows_can_be_read_at_any_time(file, tmp_path):
    table = Table(file, tmp_path)
    for row in rows(file, 3, 1):
        table.add(row)
        table.flush()
    found = parquet.read_table(tmp_path / 'rows')
    assert found.column('run').to_pylist() == [3, 1]
    assert found.schema.field('force').type == 'double'


def test_a_folder_can_be_read_after_a_batch_was_killed_while_it_wrote(file, tmp_path, monkeypatch):
    table = Table(file, tmp_path)
    table.add(rows(file, 3)[0])
    table.flush()
    table.add(rows(file, 1)[0])

    def begin(_rows, path):
        path.touch()
        raise KeyboardInterrupt

    monkeypatch.setattr(parquet, 'write_table', begin)
    with pytest.raises(KeyboardInterrupt):
        table.flush()
    assert len(list((tmp_path / 'rows').iterdir())) == 2
    assert parquet.read_table(tmp_path / 'rows').column('run').to_pylist() == [3]


def test_finished_rows_are_one_file_in_order(file, tmp_path):
    table = Table(file, tmp_path)
    for row in rows(file, 3, 1, 2):
        table.add(row)
    table.flush()
    table.finish()
    assert [path.name for path in tmp_path.iterdir()] == ['rows.parquet']
    found = parquet.read_table(tmp_path / 'rows.parquet')
    assert found.equals(table.table())
    assert found.column('run').to_pylist() == [1, 2, 3]


def test_rows_of_before_are_kept(file, tmp_path):
    first = Table(file, tmp_path)
    first.add(rows(file, 4)[0])
    first.flush()
    first.close()
    second = Table(file, tmp_path)
    assert list(second.rows) == [4]
    second.add(rows(file, 2)[0])
    second.flush()
    second.finish()
    second.close()
    assert list(Table(file, tmp_path).rows) == [2, 4]


def test_a_file_without_content_is_no_obstacle(file, tmp_path):
    (tmp_path / 'rows').mkdir()
    (tmp_path / 'rows' / '000007.parquet').touch()
    table = Table(file, tmp_path)
    table.add(rows(file, 0)[0])
    table.flush()
    table.close()
    assert list(Table(file, tmp_path).rows) == [0]


def test_rows_of_another_scenario_are_not_mixed_in(file, tmp_path):
    table = Table(file, tmp_path)
    table.add(rows(file, 0)[0])
    table.finish()
    table.close()
    with pytest.raises(ScenarioError, match='holds the rows of another scenario'):
        Table(ScenarioFile(pushed_ball()), tmp_path)


def test_a_folder_that_cannot_be_made_is_named(file, tmp_path):
    (tmp_path / 'taken').touch()
    with pytest.raises(ScenarioError, match=r'rows cannot be written to .*taken'):
        Table(file, tmp_path / 'taken')


def test_rows_that_cannot_be_read_are_named(file, tmp_path, monkeypatch):
    def refuse(_path):  # as root, nothing else does
        raise PermissionError(errno.EACCES, 'no')

    monkeypatch.setattr(parquet, 'read_table', refuse)
    path = tmp_path / 'rows.parquet'
    with pytest.raises(ScenarioError, match=f'{path} cannot be read: Permission denied'):
        Table(file, tmp_path)


def test_rows_wait_for_a_full_disk(file, tmp_path):
    table = Table(file, tmp_path)
    table.add(rows(file, 0)[0])
    with full_disk(100):
        table.flush()
    assert table.fault == f'rows cannot be written to {tmp_path / "rows"}: File too large'
    assert list((tmp_path / 'rows').iterdir()) == []
    table.add(rows(file, 1)[0])
    table.flush()
    assert table.fault == ''
    table.close()
    assert list(Table(file, tmp_path).rows) == [0, 1]


def test_folder_in_use_is_refused_until_it_is_closed(file, tmp_path):
    first = Table(file, tmp_path)
    with pytest.raises(ScenarioError, match=r'is in use by another batch; name another folder'):
        Table(file, tmp_path)
    first.add(rows(file, 0)[0])
    first.finish()
    first.close()
    assert list(Table(file, tmp_path).rows) == [0]


def test_folder_of_a_killed_batch_is_not_in_use(file, tmp_path):
    code = """
import signal, sys
sys.path[:] = sys.argv[2:]
from support.batches import pushed_ball
from rosbots_description.batch import ScenarioFile
from rosbots_description.batch.table import Table
table = Table(ScenarioFile(pushed_ball()), sys.argv[1])
print('open', flush=True)
signal.pause()
"""
    with subprocess.Popen(
        [sys.executable, '-c', code, tmp_path, *sys.path], stdout=subprocess.PIPE
    ) as other:
        assert other.stdout.readline() == b'open\n'
        with pytest.raises(ScenarioError, match='is in use by another batch'):
            Table(file, tmp_path)
        other.kill()
    Table(file, tmp_path)


def test_refused_table_leaves_no_file_open(file, tmp_path, no_collection):
    first = Table(file, tmp_path)
    before = os.listdir('/proc/self/fd')
    for _ in range(10):
        with contextlib.suppress(ScenarioError):
            Table(file, tmp_path)
    assert os.listdir('/proc/self/fd') == before
    first.close()


def test_two_batches_at_once_make_the_runs_once(tmp_path):
    made, faults = [], []

    def batch():
        try:
            made.append(run(pushed_ball(), workers=0, output=tmp_path).table.num_rows)
        except ScenarioError as error:
            faults.append(str(error))

    both = [threading.Thread(target=batch) for _ in range(2)]
    for one in both:
        one.start()
    for one in both:
        one.join()
    assert made
    assert len(made) + len(faults) == 2
    assert all('is in use by another batch' in fault for fault in faults)
