"""Scratch files: private, and written wherever there is space."""

import os
import signal
import stat
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from support import ROOT
from support.patience import wait_until
from support.programs import ran
from support.refusals import sentence_of
from support.surroundings import unshare

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.resources import scratch
from rosbots_description.sim.resources.scratch import ScratchFolder

# Fills the folders given as arguments, in a private mount namespace, then runs the program.
FILL = """
for place; do
  mount -t tmpfs -o size=4k full "$place" && head -c 4k /dev/zero > "$place/x" || exit 77
done
exec "$PYTHON" -c "$PROGRAM"
"""
NOT_PERMITTED = 77
WRITE = """
import os, resource, tempfile
from rosbots_description.sim.resources.scratch import ScratchFolder
tempfile.tempdir = os.environ.get('TMPDIR')  # chosen while there was space
resource.setrlimit(resource.RLIMIT_FSIZE, (int(os.environ.get('LARGEST', -1)),) * 2)
folder = ScratchFolder('test_')
try:
    print(folder.write('a.obj', b'content', 'bot.dae'))
finally:
    folder.close()
"""


def run(*command, **environment):
    python_path = os.pathsep.join([str(ROOT / 'src'), *sys.path])
    environment = {'PATH': os.environ['PATH'], 'PYTHONPATH': python_path, **environment}
    return ran(*command, env=environment)


@pytest.fixture
def folder():
    made = ScratchFolder('test_scratch_')
    yield made
    made.close()


@pytest.fixture
def places(tmp_path, monkeypatch):
    """Replace the folders for temporary files and shared memory by those of the test."""
    disk, memory = tmp_path / 'disk', tmp_path / 'memory'
    for place in (disk, memory):
        place.mkdir()
    monkeypatch.setattr(tempfile, 'tempdir', str(disk))
    monkeypatch.setattr(scratch, 'MEMORY', str(memory))
    return disk, memory


def test_files_are_readable_by_the_owner_only(folder):
    path = folder.write('a.obj', b'content', 'a.dae')
    assert stat.S_IMODE(path.parent.stat().st_mode) == 0o700
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert path.read_bytes() == b'content'


def test_folder_is_made_on_demand_and_removed(folder, places):
    disk, _ = places
    assert list(disk.iterdir()) == []
    path = folder.write('a.obj', b'content', 'a.dae')
    assert path.is_file()
    folder.close()
    assert list(disk.iterdir()) == []


def test_shared_memory_is_used_when_the_temporary_folder_is_gone(folder, places):
    disk, memory = places
    first = folder.write('a.obj', b'a', 'a.dae')
    first.parent.rename(disk.parent / 'away')
    disk.rmdir()
    second = folder.write('b.obj', b'b', 'b.dae')
    assert second.is_relative_to(memory)
    disk.mkdir()
    (disk.parent / 'away').rename(first.parent)
    assert first.is_file()
    assert second.is_file()


def test_error_without_any_space_names_the_mesh_and_all_folders(folder, places):
    for place in places:
        place.rmdir()
    sentence = sentence_of(ModelError, folder.write, 'a.obj', b'content', '/models/bot.dae')
    assert sentence == (
        f"mesh file '/models/bot.dae' cannot be made ready: nothing can be written in {places[0]} "
        f'(No such file or directory) nor in {places[1]} (No such file or directory); '
        'make room there, or set TMPDIR to a folder that has some'
    )


@pytest.mark.parametrize(
    ('full', 'code', 'message'),
    [
        (1, 0, '/dev/shm/test_'),
        (2, 1, '(No space left on device) nor in /dev/shm (No space left on device)'),
    ],
)
def test_shared_memory_replaces_a_full_disk(tmp_path, full, code, message):
    places = [str(tmp_path), scratch.MEMORY][:full]
    done = run(
        *unshare('mount'),
        'sh',
        '-c',
        FILL,
        'sh',
        *places,
        TMPDIR=str(tmp_path),
        PYTHON=sys.executable,
        PROGRAM=WRITE,
    )
    if done.returncode == NOT_PERMITTED:
        pytest.skip(f'this machine lets nobody mount a disk: {done.stderr.strip()}')
    assert done.returncode == code, done.stderr
    assert message in done.stdout + done.stderr


def test_file_above_the_size_limit_of_the_process_is_an_error():
    done = run(sys.executable, '-c', WRITE, LARGEST='0')
    assert done.returncode == 1
    assert "'bot.dae' cannot be made ready: nothing can be written in /tmp (" in done.stderr
    assert 'nor in /dev/shm (File too large)' in done.stderr


def test_threads_share_a_folder(folder, places, monkeypatch):
    mkdtemp = tempfile.mkdtemp

    def slow_mkdtemp(*where, **named):
        time.sleep(0.02)  # time for the other threads to write, if they could
        return mkdtemp(*where, **named)

    monkeypatch.setattr(tempfile, 'mkdtemp', slow_mkdtemp)
    ready = threading.Barrier(8)

    def write(number):
        ready.wait(60.0)
        return folder.write(f'{number}.obj', b'content', 'a.dae')

    with ThreadPoolExecutor(8) as threads:
        files = list(threads.map(write, range(8)))
    assert len({file.parent for file in files}) == 1
    assert all(file.is_file() for file in files)


def test_the_folder_is_gone_after_the_process_was_killed(tmp_path):
    program = (
        'import os, signal\n'
        'from rosbots_description.sim.resources.scratch import ScratchFolder\n'
        'folder = ScratchFolder("killed_")\n'
        'print(folder.write("m.obj", b"x", "m"), flush=True)\n'
        'os.kill(os.getpid(), signal.SIGKILL)\n'
    )
    ended = run(sys.executable, '-c', program, TMPDIR=str(tmp_path))
    assert ended.returncode == -signal.SIGKILL, ended.stderr
    assert ended.stdout.startswith(f'{tmp_path}/killed_')
    wait_until(lambda: not any(tmp_path.iterdir()))
