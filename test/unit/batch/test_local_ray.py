"""The folder of a Ray of one's own: whose it is, and that none stays behind."""

import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import MagicMock

import pytest

from rosbots_description.batch import ClusterError, local_ray


@pytest.fixture
def place(tmp_path, monkeypatch):
    """Return the folder in which temporary folders are made."""
    monkeypatch.setattr(tempfile, 'tempdir', str(tmp_path))
    monkeypatch.setattr(local_ray, '_MAX_PLACE', 1000)
    return tmp_path


def test_folders_of_killed_programs_are_removed_with_their_processes_and_no_others(place):
    abandoned, foreign = place / 'rb_abandoned', place / 'rb_foreign'
    for folder in (abandoned, foreign):
        folder.mkdir()
    (abandoned / 'rosbots.lock').touch()
    command = [sys.executable, '-c', 'print(flush=True); input()', f'{abandoned}/socket']
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as left:
        assert left.stdout.readline()  # before that, its command line may not be visible yet
        with local_ray.own_folder() as living:
            assert left.wait(timeout=60.0) == -signal.SIGKILL
            with local_ray.own_folder() as other:
                assert set(place.iterdir()) == {Path(living), Path(other), foreign}
            assert set(place.iterdir()) == {Path(living), foreign}
    assert list(place.iterdir()) == [foreign]


def test_a_folder_that_cannot_be_made_is_named(place):
    place.rmdir()
    with (
        pytest.raises(ClusterError, match=f'Ray needs a folder for its files: .*{place}'),
        local_ray.own_folder(),
    ):
        pass


@pytest.mark.parametrize(('taken', 'starts'), [(0.0, True), (110.0, True), (130.0, False)])
def test_ray_has_two_minutes_to_start(monkeypatch, taken, starts):
    inner, now = MagicMock(), [1000.0]
    ready = now[0] + taken

    def get_node(address, number):
        assert (address, number) == ('127.0.0.1:1', 'a')
        if now[0] < ready:
            raise RuntimeError('no such node')
        return {'labels': {}}

    def sleep(seconds):
        now[0] += seconds

    inner.services.get_node = get_node
    monkeypatch.setitem(sys.modules, 'ray', MagicMock())
    monkeypatch.setitem(sys.modules, 'ray._private', inner)
    monkeypatch.setattr(local_ray, 'time', SimpleNamespace(monotonic=lambda: now[0], sleep=sleep))
    with local_ray.private_environment():
        if starts:
            assert inner.services.get_node('127.0.0.1:1', 'a') == {'labels': {}}
        else:
            with pytest.raises(RuntimeError, match='no such node'):
                inner.services.get_node('127.0.0.1:1', 'a')
    assert inner.services.get_node is get_node
