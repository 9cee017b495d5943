"""A worker of parallel environments, which is replaced when it dies."""

import contextlib
import logging
import signal
from collections.abc import Callable
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode

from ..sim import SimError

logger = logging.getLogger(__name__)

_MOST_RESTARTS = 5  # in a row, without an answer between
_DYING = 10.0  # [s, wall] that a process may take to end after its pipe did
_RESTARTED = {'worker_restarted': True}  # in info

Start = Callable[[], tuple[BaseProcess, Connection]]


class WorkerError(SimError):
    """A worker failed; the message says how."""


class Worker:
    """The pipe to a worker, for AsyncVectorEnv: it answers in place of one that died.

    The episode of a worker that died is truncated: reward 0, `worker_restarted` in info, and the
    first observation of the next episode, which has begun in a new process. By AutoresetMode
    NEXT_STEP the step after that returns it again, as after every other episode.
    """

    def __init__(
        self, mode: AutoresetMode, process: BaseProcess, pipe: Connection, start: Start
    ) -> None:
        """Take over a worker that runs; `start` starts another one in its place."""
        self._mode, self._start = mode, start
        self.process, self._pipe = process, pipe
        self._request: tuple[str, Any] = ('', None)
        self._steps: list[Any] = []  # what the next steps return, in place of the worker's answers
        self._seed: int | None = None
        self._restarts = 0
        self.fault: WorkerError | None = None  # that nothing could be done about

    @property
    def closed(self) -> bool:
        """Return whether the pipe is closed."""
        return self._pipe.closed

    def close(self) -> None:
        """Close the pipe."""
        self._pipe.close()

    def poll(self, timeout: float) -> bool:
        """Return whether there is an answer within a time [s, wall]."""
        return self._has_step or self._pipe.poll(timeout)

    def send(self, request: tuple[str, Any]) -> None:
        """Send a request; one that does not arrive is answered by `recv`."""
        self._request = request
        name, data = request
        if name == 'reset':
            self._steps = []
            self._seed = data['seed'] if data['seed'] is not None else self._seed
        if not self._has_step:
            self._pass_on(request)

    def recv(self) -> tuple[Any, bool]:
        """Return the answer to the last request, and whether it was fulfilled."""
        if self._has_step:
            return self._steps.pop(0), True
        try:
            return self._answer()
        except (EOFError, ConnectionError):
            return self._replaced()

    @property
    def _has_step(self) -> bool:
        return bool(self._steps) and self._request[0] == 'step'

    def _replaced(self) -> tuple[Any, bool]:
        """Return the answer of a new worker."""
        if self._request[0] == 'close':
            return None, True
        for _ in range(_MOST_RESTARTS):
            self._restart()
            try:
                return self._answered()
            except (EOFError, ConnectionError):
                continue
        self.fault = WorkerError(
            f'{self.process.name} died {_MOST_RESTARTS} times in a row, each '
            'time it was started again'
        )
        return None, False

    def _answered(self) -> tuple[Any, bool]:
        """Return the answer of a worker that was just started, and has no episode yet."""
        name, data = self._request
        self._pass_on(('reset', data if name == 'reset' else {'seed': self._new_seed()}))
        answer, fulfilled = self._answer()
        if not fulfilled:
            return None, False
        observation, info = answer
        if name in ('reset', 'reset-noop'):
            return (observation, info | _RESTARTED), True
        self._steps = self._first_steps(observation, info)
        if name == 'step':
            return self._steps.pop(0), True
        self._pass_on(self._request)
        return self._answer()

    def _answer(self) -> tuple[Any, bool]:
        answer, fulfilled = self._pipe.recv()
        return answer, fulfilled

    def _first_steps(self, observation: object, info: dict[str, Any]) -> list[object]:
        """Return the steps that end the episode of the worker that died, and begin the next one."""
        if self._mode == AutoresetMode.SAME_STEP:
            return [
                (
                    observation,
                    0.0,
                    False,
                    True,
                    {'final_obs': observation, 'final_info': _RESTARTED, **info, **_RESTARTED},
                )
            ]
        end = (observation, 0.0, False, True, _RESTARTED)
        return (
            [end, (observation, 0.0, False, False, info)]
            if self._mode == AutoresetMode.NEXT_STEP
            else [end]
        )

    def _pass_on(self, request: tuple[str, Any]) -> None:
        with contextlib.suppress(ConnectionError):  # recv answers
            self._pipe.send(request)

    def _restart(self) -> None:
        self._pipe.close()
        self.process.join(_DYING)
        if self.process.is_alive():
            self.process.kill()
            self.process.join()
        logger.warning(
            '%s (process %s) %s; its episode is truncated, and another process takes its place',
            self.process.name,
            self.process.pid,
            self._end(),
        )
        self._restarts += 1
        self.process, self._pipe = self._start()

    def _end(self) -> str:
        """Return how the process ended, in words."""
        code = self.process.exitcode or 0
        return f'ended by {signal.Signals(-code).name}' if code < 0 else f'ended with code {code}'

    def _new_seed(self) -> int | None:
        """Return the seed of the episode after a restart; it depends on the last one given."""
        if self._seed is None:
            return None
        return int(np.random.SeedSequence((self._seed, self._restarts)).generate_state(1)[0])
