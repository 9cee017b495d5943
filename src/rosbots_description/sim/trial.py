"""A last resort: what would bring the physics engine down does so in a process of its own first.

Descriptions are checked as they are read, so nothing that is known to kill PyBullet gets this far.
For what nobody knows of yet, a model that is new to the simulator is tried in a child process,
which is this one once more with one thread and an engine of its own. That costs 0.05 s, once for
each content; nothing is kept running in between.
"""

import contextlib
import faulthandler
import gc
import hashlib
import logging
import os
import resource
import select
import signal
import stat
import threading
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import NoReturn

from .bullet_description import MeshFile
from .engine import Engine
from .errors import ModelError
from .guard import is_lost
from .model import Model
from .physics import PhysicsSettings
from .pose import IDENTITY, Pose, compose
from .spec import Mesh, ModelSpec
from .worlds import GROUND_PLANE

logger = logging.getLogger(__name__)

STEPS = 20  # enough for contacts to be found, solved and followed
PATIENCE = 10.0  # [s, wall] for what takes 0.05 s: some models are heavy, some machines slow
REMEMBERED = 1000  # contents that passed; the one that passed first is forgotten first

_PASSED = 'passed'  # what a child says at its end

OpenEngine = Callable[[PhysicsSettings, MeshFile, MeshFile], Engine]
EngineFiles = Mapping[tuple[Mesh, bool], str]  # as `mesh_needs` asks -> a file for the engine


class Trials:
    """Tries models and remembers, by their content, those that passed. Any thread may ask."""

    def __init__(self, open_engine: OpenEngine = Engine) -> None:
        self._open_engine = open_engine
        self._passed: dict[bytes, None] = {}
        self._lock = threading.Lock()  # one trial at a time; who asks for the same then finds it

    def require(self, spec: ModelSpec, physics: PhysicsSettings, files: EngineFiles) -> None:
        """Return if the engine stands the model; takes long only if the content is new.

        Where no process can be made the model passes, with a warning.

        Raises:
            ModelError: the engine crashed, hung or failed, or the model was lost at once.
        """
        content = _digest(spec, files)
        with self._lock:
            if content in self._passed:
                return
            try:
                fault = _outcome(lambda: self._live(spec, physics, files))
            except OSError as error:
                logger.warning("model '%s' comes in untried: %s", spec.name, error.strerror)
                return
            if fault:
                raise ModelError(
                    f"model '{spec.name}' is not brought in: tried in a process of its own, {fault}"
                    '; leave out parts of it to find the one that does it, meshes first'
                )
            self._passed[content] = None
            if len(self._passed) > REMEMBERED:
                del self._passed[next(iter(self._passed))]

    def _live(self, spec: ModelSpec, physics: PhysicsSettings, files: EngineFiles) -> None:
        """Do with the model what a world does: bring it in, step, ask, take it away."""
        engine = self._open_engine(
            physics, lambda mesh: files[mesh, False], lambda mesh: files[mesh, True])
        engine.add(GROUND_PLANE, IDENTITY)
        model = Model(spec.name, spec, engine, _touching(spec))
        engine.step(STEPS)
        for link in model.links.values():
            link.state()
        for joint in model.joints.values():
            joint.state()
        if is_lost(model):
            raise ModelError(f'its pose or velocity was no finite number after {STEPS} steps')
        engine.remove(model.body)


def _digest(spec: ModelSpec, files: EngineFiles) -> bytes:
    """Return a hash of all that the engine sees of a model."""
    links = [replace(link, visuals=(), sensors=()) for link in spec.links]
    seen = hashlib.sha256(repr((spec.static, links, spec.joints)).encode())
    for path in files.values():
        with open(path, 'rb') as file:
            seen.update(hashlib.file_digest(file, 'sha256').digest())
    return seen.digest()


def _touching(spec: ModelSpec) -> Pose:
    """Return a pose above the ground in which the model's lowest shape is half sunk into it."""
    heights = [
        compose(link.pose, collision.pose).position[2]
        for link in spec.links
        for collision in link.collisions
    ]
    return Pose((0.0, 0.0, -min(heights, default=0.0)))


def _outcome(trial: Callable[[], None]) -> str:
    """Return how `trial()` fails in a child process, as a clause; empty if it does not.

    Raises:
        OSError: no process could be made, or none can be watched here.
    """
    with open(os.memfd_create('trial'), 'w+b', buffering=0) as report:
        # PyBullet holds Python's lock in each of its calls, so none is under way in the copy.
        child = os.fork()
        if child == 0:
            _be_the_child(trial, report.fileno())
        code = _wait(child)
        if code is None:
            return f'the physics engine was not done with it after {PATIENCE:g} s'
        if code < 0:
            return f'it crashed the physics engine ({signal.Signals(-code).name})'
        report.seek(0)
        clause = report.read().decode(errors='replace')
    if not clause:
        return f'it ended the process (exit code {code})'
    return '' if clause == _PASSED else clause


def _wait(child: int) -> int | None:
    """Wait for the end of a child and return its exit code; None if it had to be ended."""
    ended = []
    try:
        with open(os.pidfd_open(child), 'rb', buffering=0) as process:
            watch = select.poll()
            watch.register(process, select.POLLIN)
            ended = watch.poll(1000 * PATIENCE)
    finally:
        if not ended:
            os.kill(child, signal.SIGKILL)
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return code if ended else None


def _be_the_child(trial: Callable[[], None], report: int) -> NoReturn:
    """Carry out the trial unseen and end; nothing that the parent registered runs here."""
    try:
        signal.setitimer(signal.ITIMER_REAL, 2.0 * PATIENCE)  # the end, should the parent be gone
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
        clause = f'the physics engine failed: {error!r}'
    try:
        os.write(report, clause.encode())
    finally:
        os._exit(0)


def _leave_streams_and_sockets() -> None:
    """Print nowhere, and keep nobody's connection open when the parent closes it."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    for name in os.listdir('/proc/self/fd'):
        with contextlib.suppress(OSError):  # the listing's own is gone
            if stat.S_ISSOCK(os.fstat(int(name)).st_mode):
                os.close(int(name))
