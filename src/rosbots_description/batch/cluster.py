"""Runs as tasks of Ray: on this machine, or on a cluster that there is.

Ray decides where a run is made, and repeats it elsewhere when its worker or machine is lost.
"""

import contextlib
import importlib
import signal
import socket
import threading
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any
from unittest import mock

from ..sim.core import one_line
from .local_ray import ClusterError, own_folder, private_environment
from .scenario import ScenarioFile
from .simulation import empty_row, simulate

ATTEMPTS = 5  # to make a run whose worker is lost
MAX_PENDING = 2000  # runs that Ray knows of; a few for each of a thousand processors
WAIT = 0.2  # longest wait for further rows before those that are there are taken [s, wall]
CONNECT_TIMEOUT = 10.0  # [s, wall]
STORE_BYTES = 100_000_000  # of the shared memory for objects; rows do not need it


def rows(
    file: ScenarioFile, numbers: list[int], workers: int | None, address: str | None
) -> Iterator[tuple[dict[str, Any], int]]:
    """Yield the row of each run, in any order, with the number of runs repeated so far.

    Raises:
        ClusterError: see `run`.
    """
    with _connected(workers, address) as ray:
        _require_worker(ray)
        task = ray.remote(num_cpus=1, max_retries=ATTEMPTS - 1)(_simulate)
        shared = ray.put(file)
        waiting, pending, repeated = iter(numbers), {}, 0
        try:
            while True:
                for number in waiting:
                    pending[task.remote(shared, number)] = number
                    if len(pending) >= MAX_PENDING:
                        break
                if not pending:
                    return
                ray.wait(list(pending), num_returns=1)
                ready, _ = ray.wait(list(pending), num_returns=len(pending), timeout=WAIT)
                for reference in ready:
                    row, attempts = _result(ray, file, pending.pop(reference), reference)
                    repeated += attempts - 1
                    yield row, repeated
        finally:
            for reference in pending:
                with contextlib.suppress(Exception):
                    ray.cancel(reference, force=True)


def _require_worker(ray: ModuleType) -> None:
    """Wait for the first answer of a worker."""
    from ray.exceptions import RayError

    try:
        ray.get(ray.remote(num_cpus=0, max_retries=ATTEMPTS - 1)(_attempt).remote())
    except RayError as error:
        raise ClusterError(
            f'the workers of the Ray cluster cannot make runs: {_lines(error)[-1]}'
        ) from None


def _simulate(file: ScenarioFile, number: int) -> tuple[dict[str, Any], int]:
    """Return the row of a run, and which attempt has made it."""
    return simulate(file, number), _attempt()


def _attempt() -> int:
    """Return which attempt this is to make a task of Ray, from 1."""
    from ray._private import worker

    own: Any = worker.global_worker  # its core is compiled, without types
    return 1 + int(own.core_worker.get_current_task_attempt_number())


def _result(
    ray: ModuleType,
    file: ScenarioFile,
    number: int,
    reference: object,
) -> tuple[dict[str, Any], int]:
    """Return the row of a task that has ended, in whatever way, and its number of attempts."""
    from ray.exceptions import RayError, RayTaskError

    attempts = 1
    try:
        row, attempts = ray.get(reference)
    except RayTaskError as error:  # as where this library is not installed
        reason = f'the worker could not make the run: {_lines(error)[-1]}'
    except RayError:
        attempts, reason = ATTEMPTS, f'the worker ended in each of {ATTEMPTS} attempts'
    else:
        return row, attempts
    return {**empty_row(file, file.parameters.run(number)), 'reason': one_line(reason)}, attempts


@contextlib.contextmanager
def _connected(workers: int | None, address: str | None) -> Iterator[ModuleType]:
    """Yield the module ray, connected; disconnect, and end what was started here."""
    if workers is not None and (workers < 1 or address is not None):
        raise ClusterError('workers takes at least 1, or 0 for none, and only without an address')
    ray = _ray()
    _require_listener(address)
    if address is not None or ray.is_initialized():
        # This library goes along: the cluster may know it by its other name, or not at all.
        library = str(Path(__file__).parents[1])
        with _session(ray, address=address, runtime_env={'py_modules': [library]}):
            yield ray
        return
    with (
        own_folder() as place,
        private_environment(),
        _session(
            ray,
            num_cpus=workers,
            include_dashboard=False,
            _temp_dir=f'{place}/r',
            object_store_memory=STORE_BYTES,
            address='local',
        ),
    ):
        yield ray


def _require_listener(address: str | None) -> None:
    """Refuse an address at which nothing listens, for which Ray would wait for minutes."""
    host, _, port = (address or '').removeprefix('ray://').rpartition(':')
    if host and port.isdecimal():
        try:
            socket.create_connection((host.strip('[]'), int(port)), CONNECT_TIMEOUT).close()
        except (OSError, OverflowError) as error:
            raise ClusterError(f"no Ray cluster at '{address}': {error}") from None


@contextlib.contextmanager
def _session(ray: ModuleType, **arguments: object) -> Iterator[None]:
    """Connect quietly, unless the caller has connected already."""
    if ray.is_initialized():
        yield
        return
    with _silent():
        try:
            _connect(ray, **arguments)
            yield
        finally:
            ray.shutdown()


def _connect(ray: ModuleType, **arguments: object) -> None:
    """Connect without Ray's logging and signal handler."""
    before = signal.getsignal(signal.SIGTERM) or signal.SIG_DFL
    try:
        ray.init(log_to_driver=False, configure_logging=False, logging_level='error', **arguments)
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGTERM, before)  # Ray's prints a trace
    except Exception as error:  # Ray raises many kinds
        where = arguments['address']
        what = 'Ray cannot be started' if where == 'local' else f"no Ray cluster at '{where}'"
        raise ClusterError(f'{what}: {_lines(error)[0]}') from None


def _silent() -> contextlib.AbstractContextManager[object]:
    """Keep Ray's messages about lost workers off the console.

    Ray prints them even without `log_to_driver`, in a thread that runs from `init` until the end of
    `shutdown`, so both have to be inside.
    """
    from ray._private import worker

    return mock.patch.object(worker, 'print_to_stdstream', lambda *_arguments, **_options: None)


def _ray() -> ModuleType:
    try:
        return importlib.import_module('ray')
    except ImportError:
        raise ClusterError(
            'the Python package ray is not installed; ./rosbots setup or '
            "pip install '.[ray]' installs it, and with 0 workers the runs are made "
            'in one process without it'
        ) from None


def _lines(error: Exception) -> list[str]:
    """Return the lines of an exception's text, or its type if it has none."""
    return str(error).strip().splitlines() or [type(error).__name__]
