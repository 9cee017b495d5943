"""Environments in parallel, each in a process of its own, on Gymnasium's AsyncVectorEnv."""

import logging
import multiprocessing
import os
import pickle
import queue
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from multiprocessing.connection import Connection
from multiprocessing.context import ForkProcess
from types import SimpleNamespace
from typing import Any, cast

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AsyncVectorEnv, AutoresetMode
from gymnasium.vector.async_vector_env import AsyncState, _async_worker
from gymnasium.vector.utils import CloudpickleWrapper
from gymnasium.wrappers import TimeLimit

from ..sim import SimError
from .actions import Action
from .env import SimEnv
from .worker import Worker, WorkerError

MakeEnv = Callable[[], gymnasium.Env[Any, Any]]
_TOLD = 10.0  # [s, wall] that an exception may take from a worker
_FORK = multiprocessing.get_context('fork')


class ParallelEnv(AsyncVectorEnv[Any, Any]):
    """Environments in processes, which hand over observations in shared memory.

    A process that dies is replaced (see `Worker`). None outlives this process, in which no world
    is opened.
    """

    def __init__(
        self,
        env_fns: Sequence[MakeEnv],
        *,
        copy: bool = True,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
    ) -> None:
        """Start the processes.

        Args:
            env_fns: each makes an environment, in its process; their spaces are alike.
            copy: whether observations are copied out of the shared memory, where the next step
                overwrites them.
            autoreset_mode: see Gymnasium.
        Raises:
            SimError: there are no environments; or whatever the first of `env_fns` raises.
        """
        if not env_fns:
            raise SimError('parallel environments need at least one; num_envs is 0')
        outline = _outline(env_fns[0])
        own = os.getpid()  # where AsyncVectorEnv calls the first one, too, for its spaces
        first, *others = (
            partial(_made_in_worker, make, core)
            for make, core in zip(env_fns, _cores(len(env_fns)), strict=True)
        )

        def make_first() -> gymnasium.Env[Any, Any]:
            return cast('gymnasium.Env[Any, Any]', outline) if os.getpid() == own else first()

        super().__init__(
            [make_first, *others], copy=copy, context='fork', autoreset_mode=autoreset_mode
        )
        # A worker is as much of a Connection as AsyncVectorEnv needs.
        self.parent_pipes: list[Any] = [
            Worker(self.autoreset_mode, process, pipe, partial(self._started, index))
            for index, (process, pipe) in enumerate(
                zip(self.processes, self.parent_pipes, strict=True)
            )
        ]

    def step_async(self, actions: Action) -> None:
        """Send actions to the environments.

        Raises:
            ValueError: they have the wrong shape, or a number in them is not finite.
        """
        _require(actions, self.action_space, 'the actions')
        super().step_async(actions)

    def _started(self, index: int) -> tuple[ForkProcess, Connection]:
        """Start the process of an environment again."""
        ours, theirs = _FORK.Pipe()
        process = _FORK.Process(
            target=_async_worker,
            daemon=True,
            name=f'Worker<{type(self).__name__}>-{index}',
            args=(
                index,
                CloudpickleWrapper(self.env_fns[index]),
                theirs,
                ours,
                _memory(self.observations),
                self.error_queue,
                self.autoreset_mode,
                None,
            ),
        )
        process.start()
        theirs.close()
        self.processes[index] = cast(multiprocessing.Process, process)
        return process, ours

    def _raise_if_errors(self, successes: Iterable[bool]) -> None:
        """Raise what the first failed environment raised; its process is replaced when needed."""
        failed = [*successes].count(False)
        if not failed:
            return
        self._state = AsyncState.DEFAULT
        for worker in self.parent_pipes:
            if isinstance(worker, Worker) and worker.fault is not None:
                fault, worker.fault = worker.fault, None
                raise fault
        try:
            faults = [self.error_queue.get(timeout=_TOLD) for _ in range(failed)]
        except queue.Empty:
            raise WorkerError('a worker failed with an exception that cannot be pickled') from None
        index, _, raised, trace = min(faults, key=lambda one: one[0])
        raise raised from WorkerError(f'worker {index} failed:\n{trace}')


def _memory(observations: Mapping[str, Any] | np.ndarray[Any, Any]) -> object:
    """Return the memory that observations are read from, as Gymnasium's functions take it."""
    if isinstance(observations, Mapping):
        return {name: _memory(part) for name, part in observations.items()}
    return SimpleNamespace(get_obj=lambda: observations)


def _cores(count: int) -> list[set[int]]:
    """Return the cores that each of `count` workers may use.

    With several workers per core, and as many on each, each keeps to its core: a worker that moves
    finds its data in no cache, which costs a tenth of the speed.
    """
    cores = sorted(os.sched_getaffinity(0))
    if count < 2 * len(cores) or count % len(cores):
        return [set(cores)] * count
    return [{cores[index % len(cores)]} for index in range(count)]


def _made_in_worker(make: MakeEnv, cores: set[int]) -> gymnasium.Env[Any, Any]:
    """Return an environment of this process, without the warnings that `_outline` has given."""
    os.sched_setaffinity(0, cores)
    # Workers that have got their actions do not delay the parent, which sends those of the others.
    os.sched_setscheduler(0, os.SCHED_BATCH, os.sched_param(0))
    logger = logging.getLogger(__name__.partition('.')[0])
    before = logger.level
    logger.setLevel(logging.ERROR)
    try:
        return make()
    finally:
        logger.setLevel(before)


class _Outline:
    """What AsyncVectorEnv reads of the first environment."""

    def __init__(self, env: gymnasium.Env[Any, Any]) -> None:
        self.metadata, self.render_mode = env.metadata, env.render_mode
        self.observation_space, self.action_space = env.observation_space, env.action_space

    def close(self) -> None:
        """There is nothing to close."""


def _outline(make: MakeEnv) -> _Outline:
    """Return the outline of an environment, which is made in a process and closed again."""
    ours, theirs = _FORK.Pipe(duplex=False)
    process = _FORK.Process(target=_send_outline, args=(make, theirs), daemon=True)
    process.start()
    theirs.close()
    try:
        found: _Outline | BaseException = pickle.loads(ours.recv_bytes())
    except EOFError:
        process.join()
        raise WorkerError(
            'the process of the first environment ended with code '
            f'{process.exitcode} while it was made'
        ) from None
    finally:
        ours.close()
        process.join()
    if isinstance(found, BaseException):
        raise found
    return found


def _send_outline(make: MakeEnv, pipe: Connection) -> None:
    try:
        env = make()
        found = pickle.dumps(_Outline(env))
        env.close()
    except Exception as error:
        found = pickle.dumps(error)
    pipe.send_bytes(found)


def _require(actions: Action, space: spaces.Space[Any], what: str) -> None:
    """Raise a ValueError unless actions have the shape of a space, and are finite."""
    if isinstance(space, spaces.Dict):
        if not isinstance(actions, Mapping) or actions.keys() != space.spaces.keys():
            raise ValueError(f'{what} are a dict of {", ".join(space.spaces)}; got {actions!r}')
        for name, inner in space.spaces.items():
            _require(actions[name], inner, f"{what} of '{name}'")
        return
    array = np.asarray(actions)
    if array.shape != space.shape or array.dtype.kind not in 'fiu':
        raise ValueError(
            f'{what} are numbers of shape {space.shape}; got {array.dtype} of shape {array.shape}'
        )
    if not np.isfinite(array).all():
        bad = np.argwhere(~np.isfinite(array))[0].tolist()
        raise ValueError(f'{what} are finite numbers; that at {bad} is {array[tuple(bad)]}')


def make_parallel(
    env_class: type[SimEnv],
    num_envs: int = 1,
    *,
    max_episode_steps: int | None = None,
    copy: bool = True,
    autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
    **options: Any,
) -> ParallelEnv:
    """Return environments of a class in parallel; `gymnasium.make_vec` calls this for the tasks.

    Args:
        env_class: the environment.
        num_envs: how many, at least 1.
        max_episode_steps: control periods after which an episode is truncated; None: never.
        copy: see `ParallelEnv`.
        autoreset_mode: see `ParallelEnv`.
        **options: arguments of the class.
    """

    def make() -> gymnasium.Env[Any, Any]:
        env: gymnasium.Env[Any, Any] = env_class(**options)
        return env if max_episode_steps is None else TimeLimit(env, max_episode_steps)

    return ParallelEnv([make] * num_envs, copy=copy, autoreset_mode=autoreset_mode)
