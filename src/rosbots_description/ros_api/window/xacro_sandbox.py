"""xacro for uploaded files, in a process that can do no harm.

Expressions in xacro can run any Python. So the program runs in a sandbox of bubblewrap: it has
the system's files, the ROS packages and the upload to read, nothing to write, no network, no
other processes and none of the user's environment, and ends at limits of time, memory and output.
"""

import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import BinaryIO

import rospkg

from ...sim.core import SimError
from ...sim.resources import MAX_XML_BYTES

PROCESSOR_TIME, PATIENCE = 20, 30.0  # [s] of processor and wall time
MEMORY = 2_000_000_000  # [bytes] of address space
PROCESSES = 64  # of the sandbox
SAID = 10_000  # [bytes] of the program's complaints that are read
UPLOAD = '/upload'  # the folder of the file, inside
VARIABLES = ('ROS_PACKAGE_PATH', 'ROS_ROOT', 'ROS_DISTRO', 'ROS_ETC_DIR')  # no secrets
NO_SANDBOX = (
    "'{}': xacro files can run code, so they are expanded in a sandbox only, and {}; "
    'expand it with rosrun xacro xacro, and upload the URDF'
)
NOT_INSTALLED = 'there is no program bwrap (Debian package bubblewrap)'


def expanded(name: str, content: bytes) -> bytes:
    """Return what the program xacro makes of an uploaded file.

    Raises:
        SimError: a sentence: why there is no sandbox, or what is wrong with the file.
    """
    reason = _unusable()
    if reason:
        raise SimError(NO_SANDBOX.format(name, reason))
    packages = rospkg.RosPack()
    try:
        program = Path(packages.get_path('xacro'), 'xacro')
    except rospkg.ResourceNotFound:
        raise SimError(f"'{name}': the package xacro is not there to expand it") from None
    folders = [packages.get_path(package) for package in packages.list()]
    with tempfile.TemporaryDirectory(prefix='gzweb-') as folder:
        file = Path(folder, 'upload.xacro')
        file.write_bytes(content)
        command = _sandbox([*folders, _library(), sys.prefix, sys.base_prefix])
        command += ['--ro-bind', folder, UPLOAD, '--chdir', UPLOAD, '--remount-ro', '/']
        command += ['prlimit', f'--cpu={PROCESSOR_TIME}', f'--as={MEMORY}']
        command += [f'--nproc={PROCESSES}', f'--fsize={MAX_XML_BYTES}', '--core=0']
        command += [sys.executable, '-B', '-X', 'utf8', str(program), f'{UPLOAD}/upload.xacro']
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as said:
            failed = _run(command, out, said)
            if failed:
                raise SimError(f"'{name}': xacro rejects it: {_reason(said, name)}")
            out.seek(0)
            return out.read(MAX_XML_BYTES + 1)


def _run(command: list[str], out: BinaryIO, said: BinaryIO) -> bool:
    """Run a command; return whether it failed, or took too long."""
    try:
        return bool(
            subprocess.run(
                command,
                check=False,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=said,
                timeout=PATIENCE,
            ).returncode
        )
    except subprocess.TimeoutExpired:
        return True


def _reason(said: BinaryIO, name: str) -> str:
    """Return the first line of the program's complaint."""
    said.seek(0)
    text = said.read(SAID).decode(errors='replace')
    text = text.replace(f'{UPLOAD}/upload.xacro', name).replace(f'{UPLOAD}/', '')
    lines = (line.removeprefix('error:').strip() for line in text.splitlines())
    return next(filter(None, lines), 'it takes too much time, memory or output')


@cache
def _unusable() -> str:
    """Return why there is no sandbox; '' if there is one."""
    if shutil.which('bwrap') is None or shutil.which('prlimit') is None:
        return NOT_INSTALLED
    ended = subprocess.run(
        [*_sandbox([]), 'true'], check=False, capture_output=True, stdin=subprocess.DEVNULL
    )
    if ended.returncode == 0:
        return ''
    said = ended.stderr.decode(errors='replace').strip().splitlines()
    return f'bwrap does not work here ({said[0] if said else ended.returncode})'


def _library() -> str:
    """Return the folder from which xacro imports this package; others it has of the interpreter.

    Not all folders of this process's modules: those of PYTHONPATH, and the one in which it was
    started by `python3 -m`, may hold anything of the user.
    """
    spec = importlib.util.find_spec('rosbots_simulator')
    assert spec is not None and spec.origin is not None
    return os.path.dirname(os.path.dirname(spec.origin))


def _sandbox(folders: Iterable[str]) -> list[str]:
    """Return the command line of a sandbox that shows some folders besides the system's own."""
    made = ['bwrap', '--unshare-all', '--die-with-parent', '--new-session', '--clearenv']
    made += ['--cap-drop', 'ALL']
    environment = {
        'PATH': '/usr/bin:/bin',
        'LANG': 'C.UTF-8',
        'HOME': '/',
        'ROS_HOME': '/',
        'PYTHONPATH': _library(),
        **{name: os.environ[name] for name in VARIABLES if name in os.environ},
    }
    for name, value in environment.items():
        made += ['--setenv', name, value]
    made += ['--ro-bind', '/usr', '/usr', '--ro-bind-try', '/etc/ld.so.cache', '/etc/ld.so.cache']
    for system in ('/bin', '/lib', '/lib32', '/lib64', '/sbin'):
        if os.path.islink(system):
            made += ['--symlink', os.readlink(system), system]
        elif os.path.isdir(system):
            made += ['--ro-bind', system, system]
    made += ['--dev-bind', '/dev/null', '/dev/null', '--dev-bind', '/dev/urandom', '/dev/urandom']
    for folder in _apart(folders):
        made += ['--ro-bind', folder, folder]
    return made


def _apart(folders: Iterable[str]) -> Iterator[str]:
    """Yield folders that exist, and what they are links to; none twice, and none in another.

    A folder around the user's home is left out: it is no package, whatever its manifest says.
    """
    home = os.path.realpath(os.path.expanduser('~'))
    wanted = {
        os.path.normpath(one)
        for folder in folders
        if os.path.isabs(folder)
        for one in (folder, os.path.realpath(folder))
        if os.path.isdir(one)
    }
    shown = ['/usr']
    for folder in sorted(wanted, key=lambda one: (one.count('/'), one)):
        if f'{home}/'.startswith(f'{folder.rstrip("/")}/'):
            continue
        if not any(f'{folder}/'.startswith(f'{one}/') for one in shown):
            shown.append(folder)
            yield folder
