"""A last resort: what would bring the physics engine down does so in a process of its own first.

Descriptions are checked as they are read, so nothing that is known to kill PyBullet gets this far.
For what nobody knows of yet, a model that is new to the simulator is tried in a child process,
which is this one once more, with one thread and without what is in the world. That costs 0.03 s,
once for each content; nothing is kept running in between. A heavy model costs 0.15 s, or what it
takes to bring it in and make one step. Only processor time counts: a machine that is busy with
other things must not make a model look bad.
"""

import contextlib
import errno
import faulthandler
import gc
import hashlib
import logging
import os
import resource
import signal
import stat
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import NoReturn

from ...core import IDENTITY, ModelError, Pose, compose
from ...description import GROUND_PLANE, Mesh, ModelSpec
from .body_maker import grouped
from .engine import Engine
from .generated_urdf import MeshFile, kinematic_trees, mesh_needs

logger = logging.getLogger(__name__)

STEPS = 20  # enough for contacts to be found, solved and followed
BUDGET = 0.15  # [s, processor] from which on a heavy model makes no further step

# [s, processor] after which a trial hangs: some ten times what heavy models of its size take.
LEAST, FOR_A_PART, FOR_A_BYTE = 2.0, 0.01, 1e-6
MOST = 60.0  # what is not in by then would stop the world for as long
PATIENCE = 5.0  # times that, by the wall clock, for what hangs asleep

REMEMBERED = 1000  # contents that passed; the one that passed first is forgotten first

# What a child says at its end: that, or what is wrong with the model, or with the system.
_PASSED = 'passed'
_SYSTEM = 'system: '
_ROOM = 4096  # [bytes] for that, set aside before, so that a full machine cannot silence a child
_HANDLES = 8  # more files than the engine has open at once
_KILLED = 'it killed the process (SIGKILL), as it does where memory runs out'

EmptyEngine = Callable[[MeshFile, MeshFile], Engine]  # as `Engine.emptied`
EngineFiles = Mapping[tuple[Mesh, bool], str]  # as `mesh_needs` asks -> a file for the engine


class SystemFailure(Exception):  # noqa: N818  no fault of ours or of the model
    """The operating system failed in a trial; `str()` is how."""


class Trials:
    """Tries models and remembers, by their content, those that passed. Any thread may ask."""

    def __init__(self, empty_engine: EmptyEngine) -> None:
        """Let a child process have that engine; it is called there only."""
        self._empty_engine = empty_engine
        self._passed: dict[bytes, None] = {}
        self._lock = threading.Lock()  # one trial at a time; who asks for the same then finds it

    def require(self, spec: ModelSpec, files: EngineFiles) -> None:
        """Return if the engine stands the model; takes long only if the content is new.

        Where no process can be made the model passes, with a warning.

        Raises:
            ModelError: the engine crashed, hung or failed, or the model was lost at once; or the
                operating system failed, which tells nothing about the model.
        """
        try:
            content = _digest(spec, files)
            if content not in self._passed:  # else without waiting for somebody else's trial
                self._try(spec, files, content)
        except SystemFailure as failure:
            raise ModelError(
                f"model '{spec.name}' is not brought in: it could not be tested before, since the "
                f'operating system failed ({failure}); mend that and spawn the model again'
            ) from None

    def _try(self, spec: ModelSpec, files: EngineFiles, content: bytes) -> None:
        with self._lock:
            if content in self._passed:
                return
            with contextlib.suppress(Exception):  # it fails in the child, too, which tells why
                for tree in kinematic_trees(spec):  # the child and the world recall what this finds
                    grouped(tree, lambda mesh, stands=tree.stands: files[mesh, stands])
            try:
                fault = _outcome(lambda: self._live(spec, files), _allowance(spec, files))
            except OSError as error:
                logger.warning("model '%s' comes in without being tested, since the operating "
                               'system failed (%s)', spec.name, error.strerror)
                return
            if fault:
                raise ModelError(
                    f"model '{spec.name}' is not brought in: tried in a process of its own, {fault}"
                    '; leave out parts of it to find the one that does it, meshes first'
                )
            self._passed[content] = None
            if len(self._passed) > REMEMBERED:
                del self._passed[next(iter(self._passed))]

    def _live(self, spec: ModelSpec, files: EngineFiles) -> None:
        """Do with the model what a world does: bring it in, step, ask, take it away."""
        engine = self._empty_engine(
            lambda mesh: files[mesh, False], lambda mesh: files[mesh, True])
        engine.add(GROUND_PLANE, IDENTITY)
        body = engine.add(spec, _touching(spec))
        for _ in range(STEPS):
            engine.step(1)
            if time.process_time() > BUDGET:
                break
        for link in body.parts:
            engine.link_state(body, link)
        for joint in body.joints:
            engine.joint_reading(body, joint)
        if engine.has_diverged(body):
            raise ModelError(f'its pose or velocity was no finite number within {STEPS} steps')
        engine.remove(body)


def _digest(spec: ModelSpec, files: EngineFiles) -> bytes:
    """Return a hash of all that the engine sees of a model.

    Raises:
        SystemFailure: a file for the engine cannot be read, though it was written just now.
    """
    links = [replace(link, visuals=(), sensors=()) for link in spec.links]
    seen = hashlib.sha256(repr((spec.static, links, spec.joints)).encode())
    for path in files.values():
        try:
            with open(path, 'rb') as file:
                seen.update(hashlib.file_digest(file, 'sha256').digest())
        except OSError as error:
            raise SystemFailure(f'{error.strerror}: {path}') from error
    return seen.digest()


def _touching(spec: ModelSpec) -> Pose:
    """Return a pose above the ground in which the model's lowest shape is half sunk into it."""
    heights = [
        compose(link.pose, collision.pose).position[2]
        for link in spec.links
        for collision in link.collisions
    ]
    return Pose((0.0, 0.0, -min(heights, default=0.0)))


def _allowance(spec: ModelSpec, files: EngineFiles) -> float:
    """Return the processor time [s] that the trial of a model may take."""
    parts = sum(1 + len(link.collisions) for link in spec.links)
    size = sum(os.path.getsize(files[need]) for need in mesh_needs(spec))
    return min(MOST, LEAST + FOR_A_PART * parts + FOR_A_BYTE * size)


def _outcome(trial: Callable[[], None], allowance: float) -> str:
    """Return how `trial()` fails in a child process, as a clause; empty if it does not.

    Args:
        allowance: processor time [s] after which it hangs.

    Raises:
        OSError: no process could be made.
        SystemFailure: the operating system failed there, not the engine.
    """
    with open(os.memfd_create('trial'), 'w+b', buffering=0) as report:
        os.posix_fallocate(report.fileno(), 0, _ROOM)
        # PyBullet holds Python's lock in each of its calls, so none is under way in the copy.
        child = os.fork()
        if child == 0:
            _be_the_child(trial, allowance, report.fileno())
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        spent = {
            -signal.SIGPROF: f'{allowance:.1f} s of processor time',
            -signal.SIGALRM: f'{PATIENCE * allowance:.1f} s',
        }.get(code)
        if spent:
            return f'the physics engine was not done with it after {spent}'
        if code == -signal.SIGKILL:
            raise SystemFailure(_KILLED)
        if code < 0:
            return f'it crashed the physics engine ({signal.Signals(-code).name})'
        report.seek(0)
        clause = report.read().rstrip(b'\0').decode(errors='replace')
    if not clause:
        return f'it ended the process (exit code {code})'
    if clause.startswith(_SYSTEM):
        raise SystemFailure(clause.removeprefix(_SYSTEM))
    return '' if clause == _PASSED else clause


def _be_the_child(trial: Callable[[], None], allowance: float, report: int) -> NoReturn:
    """Carry out the trial unseen and end; nothing that the parent registered runs here."""
    try:
        _end_after(allowance)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)  # it ends by itself
        faulthandler.disable()
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))  # a crash leaves no file behind
        logging.disable()
        gc.disable()  # what the parent's objects do at their end is not for us to do
        _leave_streams_and_sockets()
        trial()
        clause = _PASSED
    except ModelError as error:
        clause = str(error)
    except BaseException as error:
        shortage = _shortage(error)
        clause = f'{_SYSTEM}{shortage}' if shortage else f'the physics engine failed: {error!r}'
    try:
        os.write(report, clause.encode()[:_ROOM])
    finally:
        os._exit(0)


def _shortage(error: BaseException) -> str | None:
    """Return what the operating system could not give, if that is why a trial failed."""
    if isinstance(error, MemoryError):
        return os.strerror(errno.ENOMEM)
    try:
        if isinstance(error, OSError):
            raise error
        for _ in range(_HANDLES):  # PyBullet does not tell why it could not open a file
            os.open(os.devnull, os.O_RDONLY)
    except OSError as fault:
        return fault.strerror or str(fault)
    return None


def _end_after(allowance: float) -> None:
    """Let the system end this process, whatever it does, after so much processor time [s]."""
    for number, timer, seconds in (
        (signal.SIGPROF, signal.ITIMER_PROF, allowance),
        (signal.SIGALRM, signal.ITIMER_REAL, PATIENCE * allowance),
    ):
        signal.signal(number, signal.SIG_DFL)
        signal.setitimer(timer, seconds)


def _leave_streams_and_sockets() -> None:
    """Print nowhere, and keep nobody's connection open when the parent closes it."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    for name in os.listdir('/proc/self/fd'):
        with contextlib.suppress(OSError):  # the listing's own is gone
            if stat.S_ISSOCK(os.fstat(int(name)).st_mode):
                os.close(int(name))
