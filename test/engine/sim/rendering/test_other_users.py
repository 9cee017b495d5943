"""Another user of the machine reaches nothing of a simulator: its processes, memory and files."""

import contextlib
import os
import pickle
import tempfile
from pathlib import Path

import pytest
from support import robot_spec
from support.pictures import recorded_world, spawn_robot
from support.programs import ran

from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.physics import CrashSandbox, make_engine
from rosbots_description.sim.rendering.image_capture import renderer_of

OTHER = 65534  # nobody
PROCESSES = 'simulator', 'renderer', 'sandbox'
# Python, for it has no shell: what it prints was reached.
REACH = """
import os, sys
os.setgroups([]); os.setgid({other}); os.setuid({other})
print('begun')
try:
    {attempt}
except OSError:
    sys.exit()
print('reached')
"""
ATTEMPTS = {
    'its files': "os.listdir('/proc/{process}/fd')",
    'a shared file': "os.open('/proc/{process}/fd/{file}', os.O_RDONLY)",
    'its environment': "open('/proc/{process}/environ').read()",
    'its memory': "open('/proc/{process}/mem', 'rb')",
    'its map': "open('/proc/{process}/maps').read()",
    'its folder': "os.listdir('/proc/{process}/cwd')",
    'its end': 'os.kill({process}, 9)',
    'its rest': 'os.kill({process}, 19)',
    'its descriptors': 'import signal; signal.pidfd_send_signal(os.pidfd_open({process}), 15)',
}


@pytest.fixture(scope='module', name='running')
def fixture_running():
    """Yield the ids of all processes of a world with a camera, a mesh and a sandbox."""
    if os.getuid():
        pytest.skip('only root can try what another user can do')
    before = os.umask(0)
    with recorded_world() as world, CrashSandbox(world.engine, make_engine) as sandbox:
        _, camera = spawn_robot(world, 'camera_320')
        world.spawn(robot_spec(), 'rosbots', Pose((0.0, 3.0, 0.5)))
        camera.read()
        yield {
            'simulator': os.getpid(),
            'renderer': renderer_of(world).process.process_id,
            'sandbox': sandbox._children._server.process,
        }
    os.umask(before)


def reached(attempt):
    run = ran('/usr/bin/python3', '-c', REACH.format(other=OTHER, attempt=attempt), cwd='/')
    assert run.stdout.startswith('begun'), run.stderr
    return 'reached' in run.stdout


@pytest.mark.parametrize('process', PROCESSES)
@pytest.mark.parametrize('what', ATTEMPTS)
def test_another_user_does_not_reach_a_process(running, process, what):
    number = running[process]
    files = [name for name in os.listdir(f'/proc/{number}/fd') if int(name) > 2]
    assert not reached(ATTEMPTS[what].format(process=number, file=files[0]))
    assert os.path.exists(f'/proc/{number}')


def sockets(process):
    """Return the inodes of the sockets of a process."""
    found = set()
    for name in os.listdir(f'/proc/{process}/fd'):
        with contextlib.suppress(FileNotFoundError):  # that of the listing itself
            found.add(os.readlink(f'/proc/{process}/fd/{name}'))
    return {one[8:-1] for one in found if one.startswith('socket:[')}


@pytest.mark.parametrize('process', PROCESSES)
def test_no_socket_of_a_process_has_a_name(running, process):
    inodes = sockets(running[process])
    assert inodes
    named = {
        fields[6]: fields[7]
        for line in Path('/proc/net/unix').read_text().splitlines()[1:]
        if len(fields := line.split()) > 7
    }
    assert not inodes & named.keys()


def test_no_process_listens_on_the_network(running):
    listening = {
        line.split()[9]
        for table in ('tcp', 'tcp6')
        for line in Path(f'/proc/net/{table}').read_text().splitlines()[1:]
        if line.split()[3] == '0A'
    }
    for process in running.values():
        assert not sockets(process) & listening


@pytest.mark.parametrize('mask', [0o000, 0o022])
def test_temporary_files_are_private_whatever_the_umask(running, mask, tmp_path, monkeypatch):
    from rosbots_description.sim.resources.scratch import ScratchFolder

    monkeypatch.setattr(tempfile, 'tempdir', str(tmp_path))
    tmp_path.chmod(0o777)
    os.umask(mask)
    scratch = ScratchFolder('mesh-')
    file = scratch.write('part.obj', b'v 0 0 0', 'part.stl')
    assert file.parent.stat().st_mode & 0o777 == 0o700
    assert file.stat().st_mode & 0o777 == 0o600
    assert not reached(f"os.listdir('{file.parent}')")
    assert not reached(f"open('{file}')")
    assert not reached(f"open('{file}', 'w')")
    scratch.close()
    os.umask(0)


@pytest.mark.parametrize(
    'content', [pickle.dumps({'world': 'default'}), b'\x80\x04\x95', b'cos\nsystem\n(S"id"\ntR.']
)
def test_world_file_is_never_unpickled(tmp_path, content):
    from rosbots_description.sim import SimError, World

    path = tmp_path / 'saved.world'
    path.write_bytes(content)
    with pytest.raises(SimError):
        World.from_file(path)
