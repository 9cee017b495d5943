"""Test new models in a child process, so that none can crash the simulator.

Descriptions are checked as they are read and compiled, so nothing known to crash an engine gets
this far. Against unknown faults a model that is new to the simulator is tested in a child process,
in an empty world. That costs 0.03 s of processor time, once per content; a heavy model costs
0.15 s, or the time to add it and make one step. Only processor time counts, so that the result does
not depend on the load of the machine.
"""

import errno
import hashlib
import os
import pickle
import signal
import threading
import time
from collections.abc import Callable
from functools import partial

from ..core import HUNG_TIME, IDENTITY, Fault, ModelError, Pose, compose, report
from ..description import GROUND_PLANE, ModelSpec, PhysicsSettings
from .compiled_model import CompiledModel
from .engine import EngineFactory, PhysicsEngine
from .fork_server import Cancelled, ForkServer, Killed, Work

STEPS = 20  # enough for contacts to be found, solved and followed
BUDGET = 0.15  # [s, processor] after which a heavy model makes no further step

# [s, processor] after which an engine counts as hung: about ten times the need of heavy models.
# PyBullet allocates contacts one by one, so its first step with n coincident boxes takes
# 5e-7 s * n^4: 3 s for 50.
MIN_ALLOWANCE, PER_PART, PER_BYTE = 2.0, 0.2, 1e-6
MAX_ALLOWANCE = 60.0  # adding such a model would stall the world for as long

REMEMBERED = 1000  # contents that passed; the oldest is forgotten first

# The report of a child: this, or a fault of the model or of the system.
_PASSED = 'passed'
_SYSTEM = 'system: '
_HANDLES = 8  # more files than the engine has open at once
_KILLED = 'it killed the process (SIGKILL), as it does where memory runs out'


class CrashSandbox:
    """Tests models, and remembers those that passed by their content. Thread-safe."""

    def __init__(self, engine: PhysicsEngine, make_engine: EngineFactory) -> None:
        """Start the process that tests models; do so before there are threads.

        Args:
            engine: one with an empty world. The fork copies it, which is faster than opening one.
            make_engine: makes an equal one, for a process that replaces one that was killed.
        """
        self._children = ForkServer(
            partial(_prepared, engine), 'crash_sandbox', partial(_prepared_anew, make_engine)
        )
        self._passed: dict[bytes, None] = {}
        self._under_way: set[bytes] = set()
        self._changed = threading.Condition()  # guards the passed and the pending contents

    def __enter__(self) -> 'CrashSandbox':
        return self

    def __exit__(self, *_exception: object) -> None:
        self.close()

    def close(self) -> None:
        """End the process; no model can be tested any more."""
        self._children.close()

    def require(
        self,
        model: CompiledModel,
        physics: PhysicsSettings,
        is_wanted: Callable[[], bool] = lambda: True,
    ) -> None:
        """Return if the engine survives the model; fast unless the content is new.

        If no process can be started, the model passes with a warning.

        Args:
            physics: the settings to test it with.
            is_wanted: polled after 5 s and later; whether to continue.
        Raises:
            ModelError: the engine crashed, hung or failed, or the model diverged at once; or the
                operating system failed, which says nothing about the model; or it is not wanted.
        """
        bare = model.bare()
        content = hashlib.sha256(repr(bare).encode()).digest()
        with self._changed:
            self._changed.wait_for(lambda: content not in self._under_way)
            if content in self._passed:
                return
            self._under_way.add(content)
        passed = False
        try:
            passed = self._test(model.spec.name, bare, physics, is_wanted)
        finally:
            with self._changed:
                self._under_way.remove(content)
                if passed:
                    self._passed[content] = None
                    if len(self._passed) > REMEMBERED:
                        del self._passed[next(iter(self._passed))]
                self._changed.notify_all()

    def _test(
        self,
        name: str,
        model: CompiledModel,
        physics: PhysicsSettings,
        is_wanted: Callable[[], bool],
    ) -> bool:
        """Return whether the engine survived a model; False if that is unknown."""
        allowance = _allowance(model)
        try:
            outcome = self._children.run(pickle.dumps((model, physics)), allowance, is_wanted)
        except OSError as error:
            report(
                Fault(
                    f"model '{name}' was not tested in the sandbox, since the operating system "
                    f'failed ({error.strerror})',
                    model=name,
                )
            )
            return False
        except Cancelled:
            raise ModelError(f"model '{name}' is rejected: its client has disconnected") from None
        except Killed as killed:
            outcome = _exit_reason(killed.exit_code, allowance)
        if outcome.startswith(_SYSTEM):
            raise ModelError(
                f"model '{name}' is rejected: it could not be tested before, since the "
                f'operating system failed ({outcome.removeprefix(_SYSTEM)}); fix that and spawn '
                'the model again'
            )
        if outcome != _PASSED:
            raise ModelError(
                f"model '{name}' is rejected: tested in a process of its own, {outcome}"
                '; leave out parts of it to find the one that does it, meshes first'
            )
        return True


def _allowance(model: CompiledModel) -> float:
    """Return the processor time [s] that the test of a model may take."""
    parts = sum(1 + len(link.collisions) for link in model.spec.links)
    return min(MAX_ALLOWANCE, MIN_ALLOWANCE + PER_PART * parts + PER_BYTE * model.size)


def _exit_reason(exit_code: int, allowance: float) -> str:
    """Return the reason why a process ended, as a clause."""
    match -exit_code:
        case signal.SIGPROF:
            return f'the physics engine needed more than {allowance:.1f} s of processor time for it'
        case signal.SIGALRM:
            return f'the physics engine hung for {HUNG_TIME:g} s'
        case signal.SIGKILL:
            return f'{_SYSTEM}{_KILLED}'
        case number if number > 0:
            return f'it crashed the physics engine ({signal.Signals(number).name})'
    return f'it ended the process (exit code {exit_code})'


def _prepared(engine: PhysicsEngine) -> Work:
    """Return the function that tests a model; called in the child process."""
    engine.add(engine.compile(GROUND_PLANE), IDENTITY)
    return partial(_report, engine)


def _prepared_anew(make_engine: EngineFactory) -> Work:
    return _prepared(make_engine(PhysicsSettings()))


def _report(engine: PhysicsEngine, payload: bytes) -> str:
    try:
        model, physics = pickle.loads(payload)
        unreadable = next(filter(None, map(_read_fault, model.files)), None)
        if unreadable:
            return f'{_SYSTEM}{unreadable}'
        engine.apply(physics)
        _simulate(engine, model)
    except ModelError as error:
        return str(error)
    except BaseException as error:
        shortage = _shortage(error)
        return f'{_SYSTEM}{shortage}' if shortage else f'the physics engine failed: {error!r}'
    return _PASSED


def _simulate(engine: PhysicsEngine, model: CompiledModel) -> None:
    """Use the model as a world does: add it, step, read, remove it."""
    body = engine.add(model, _touching_pose(model.spec))
    for _ in range(STEPS):
        engine.step(1)
        if time.process_time() > BUDGET:
            break
    for link in model.spec.links:
        engine.link_state(body, link.name)
    for joint in body.joints:
        engine.joint_state(body, joint)
    if engine.has_diverged(body):
        raise ModelError(f'its pose or velocity was not finite within {STEPS} steps')
    engine.remove(body)


def _touching_pose(spec: ModelSpec) -> Pose:
    """Return a pose in which the model's lowest shape is half below the ground."""
    heights = [
        compose(link.pose, collision.pose).position[2]
        for link in spec.links
        for collision in link.collisions
    ]
    return Pose((0.0, 0.0, -min(heights, default=0.0)))


def _shortage(error: BaseException) -> str | None:
    """Return which resource the operating system lacked, if that is why a test failed."""
    if isinstance(error, MemoryError):
        return os.strerror(errno.ENOMEM)
    try:
        if isinstance(error, OSError):
            raise error
        for _ in range(_HANDLES):  # an engine may not report why it could not open a file
            os.open(os.devnull, os.O_RDONLY)
    except OSError as fault:
        return fault.strerror or str(fault)
    return None


def _read_fault(path: str) -> str | None:
    """Return why a file cannot be read, if so; an engine may not report it."""
    try:
        with open(path, 'rb'):
            return None
    except OSError as error:
        return f'{error.strerror}: {path}'
