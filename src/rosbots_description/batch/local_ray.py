"""Folder and environment of a Ray that is started on this machine for one batch."""

import contextlib
import fcntl
import os
import secrets
import shutil
import signal
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import IO, Any, ParamSpec, TypeVar

from ..sim import SimError

P = ParamSpec('P')
T = TypeVar('T')

_PREFIX, _LOCK = 'rb', 'rosbots.lock'  # of the folder of a Ray that is started here
_MAX_PLACE = 28  # characters of a folder in which Ray's sockets have names that Linux takes
# [s, wall] for Ray to start: on a machine with thirty busy programs it has taken more than the 30 s
# that it gives its server, the raylet's agents and the raylet.
_START_TIME, _START_POLL = 120, 0.1
# For Ray on this machine alone: only the loopback interface (the switch is named after the systems
# where it is off by default), only processes that have the token, and no statistics sent.
_PRIVATE = {
    'RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER': '0',
    'RAY_AUTH_MODE': 'token',
    'RAY_USAGE_STATS_ENABLED': '0',
    'RAY_gcs_server_port_wait_time_s': str(_START_TIME),
    'RAY_agent_register_timeout_ms': str(1000 * _START_TIME),
}


class ClusterError(SimError):
    """Ray is not installed, cannot be started or cannot be reached."""


@contextlib.contextmanager
def private_environment() -> Iterator[None]:
    """Set the environment of a Ray that is started here; Ray may have been imported before.

    Ray is given two minutes to start.
    """
    values = {**_PRIVATE, 'RAY_AUTH_TOKEN': secrets.token_hex(32)}
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    _read_environment()
    try:
        with _patient_start(), _without_monitors():
            yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
        _read_environment()


def _patient_start() -> contextlib.AbstractContextManager[object]:
    """Let Ray wait longer for the raylet to register; its own limit of 30 s has no setting."""
    from unittest import mock  # slow to import, as is Ray

    from ray._private import services

    untyped: Any = services
    return mock.patch.object(untyped, 'get_node', _waiting(untyped.get_node))


def _without_monitors() -> contextlib.AbstractContextManager[object]:
    """Start Ray without its monitors, which no batch reads; `init` has no switch for them.

    They are the monitor of logs, that of the autoscaler, and the dashboard, of which
    `include_dashboard=False` leaves the part for statistics. Each is a Python program.
    """
    from unittest import mock

    from ray._private import node

    untyped: Any = node
    monitors = ('start_log_monitor', 'start_monitor', 'start_api_server')
    return mock.patch.multiple(untyped.Node, **dict.fromkeys(monitors, mock.DEFAULT))


def _waiting(get_node: Callable[P, T]) -> Callable[P, T]:
    """Return `get_node`, which raises a RuntimeError until there is a node, with patience."""

    def wait_for_node(*args: P.args, **kwargs: P.kwargs) -> T:
        end = time.monotonic() + _START_TIME
        while True:
            try:
                return get_node(*args, **kwargs)
            except RuntimeError:
                if time.monotonic() > end:
                    raise
                time.sleep(_START_POLL)

    return wait_for_node


def _read_environment() -> None:
    """Let Ray read the environment again, as its own tests do."""
    from ray import _raylet
    from ray._private import ray_constants as constants

    ray_constants: Any = constants  # untyped, as the next
    ray_constants.ENABLE_RAY_CLUSTER = ray_constants.env_bool(
        ray_constants.ENABLE_RAY_CLUSTERS_ENV_VAR, True
    )
    inner: Any = _raylet
    inner.Config.initialize('')
    inner.AuthenticationTokenLoader.instance().reset_cache()


@contextlib.contextmanager
def own_folder() -> Iterator[str]:
    """Yield a folder for Ray's files; remove it, and those of programs that were killed.

    No other user can reach what is in it. Ray lets everybody write in the folder that it is given,
    so that is to be one within it.

    Raises:
        ClusterError: it cannot be made, as on a full disk.
    """
    try:
        made, lock = _locked_folder()
    except OSError as error:
        raise ClusterError(f'Ray needs a folder for its files: {error}') from None
    try:
        with lock:
            yield str(made)
    finally:
        _remove(made)


def _locked_folder() -> tuple[Path, IO[str]]:
    """Return a new folder, and the file in it that is locked as long as its program lives."""
    remove_left_folders()
    made = Path(tempfile.mkdtemp(prefix=_PREFIX, dir=_place()))
    lock = (made / 'new').open('w')
    fcntl.flock(lock, fcntl.LOCK_EX)
    (made / 'new').rename(made / _LOCK)
    return made, lock


def _place() -> str:
    place = tempfile.gettempdir()
    return place if len(place) <= _MAX_PLACE else '/tmp'


def remove_left_folders() -> None:
    """Remove the folders, and end the Ray, of programs of this user that were killed."""
    for path in Path(_place()).glob(f'{_PREFIX}*'):
        with contextlib.suppress(OSError):
            _remove_if_left(path)


def _remove_if_left(folder: Path) -> None:
    """Remove a folder of this user whose program does not live any more.

    Anyone can make such a name: a link, or a pipe in place of the file, is not followed or opened.

    Raises:
        OSError: it is not one of these, or its program lives.
    """
    if folder.lstat().st_uid != os.getuid():
        return
    inside = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    try:
        lock = os.open(_LOCK, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK, dir_fd=inside)
    finally:
        os.close(inside)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        _remove(folder)
    finally:
        os.close(lock)


def _remove(folder: Path) -> None:
    """Remove a folder of Ray, and end the processes that still use it."""
    for process in Path('/proc').glob('[0-9]*'):  # Ray leaves some where it could not start
        with contextlib.suppress(OSError):
            if bytes(folder) in (process / 'cmdline').read_bytes():
                os.kill(int(process.name), signal.SIGKILL)
    shutil.rmtree(folder, ignore_errors=True)
