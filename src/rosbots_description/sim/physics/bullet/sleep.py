"""Lets bodies that rest sleep, and wakes them before the step in which something acts on them.

While all bodies sleep, the engine makes no steps. While only some do, PyBullet leaves them out,
unless they touch or nearly touch one that is awake: it joins bodies whose bounding boxes overlap
to islands, which move as a whole. Nothing else wakes PyBullet's sleepers, and they start with the
step after that in which they are woken. So whatever acts on bodies must call `wake` or `wake_all`
here first.
"""

import math
from collections.abc import Callable, Collection, Iterable
from typing import Any

from .body import Body
from .client import pybullet

# What moves less falls asleep: the root of v^2 + w^2 and the squares of joint velocities [m/s and
# rad/s]. ODE's own limits are 0.01 each. What rests here moves by 3e-5, and a box on another one,
# which the solver turns, by 3e-4.
SLOW = 1e-3
# Steps between two looks at the velocities. They take turns, as those of a body that swings with
# a period of twenty steps would be zero at every twentieth step.
LOOKS = (17, 20, 23)
_SLEEP = pybullet.ACTIVATION_STATE_ENABLE_SLEEPING | pybullet.ACTIVATION_STATE_SLEEP
_WAKE = pybullet.ACTIVATION_STATE_DISABLE_SLEEPING | pybullet.ACTIVATION_STATE_WAKE_UP


class Sleep:
    """Which bodies of a PyBullet world rest, and which of them sleep."""

    def __init__(self, client: int, make_void_step: Callable[[], None]) -> None:
        """Work in the world of that PyBullet client, which is empty.

        Args:
            make_void_step: makes a step of PyBullet and undoes it.
        """
        self._client, self._make_void_step = client, make_void_step
        self._rested: dict[int, int] = {}  # steps, by each moving body
        self._asleep: dict[int, None] = {}  # those that PyBullet leaves out
        self.measured: set[tuple[int, int]] = set()  # joints whose reactions PyBullet computes
        self.is_complete = False  # everything sleeps, and the engine stands still
        self.until_look = LOOKS[0]
        self._turn = 0
        self._needed = math.inf

    def set_rest(self, steps: float) -> None:
        """Set the number of steps for which a body must have rested."""
        self._needed = steps

    def add(self, numbers: Iterable[int]) -> None:
        """Add moving bodies, given by PyBullet's numbers."""
        self._rested.update(dict.fromkeys(numbers, 0))

    def remove(self, numbers: Collection[int]) -> None:
        """Remove bodies."""
        for number in numbers:
            self._rested.pop(number, None)
            self._asleep.pop(number, None)
        self.measured = {joint for joint in self.measured if joint[0] not in numbers}

    def clear(self) -> None:
        """Remove all bodies."""
        self.remove([*self._rested])
        self.wake_all()

    def wake(self, number: int) -> None:
        """Wake a body, and those that it touches, for something is about to act on it."""
        if number not in self._rested:
            return  # it never moves
        self._rested[number] = 0
        self.is_complete = False
        if number in self._asleep:
            self._rouse(self._island(number))

    def wake_all(self) -> None:
        """Wake all bodies, for something is about to happen that may act on any."""
        self._rested = dict.fromkeys(self._rested, 0)
        self.is_complete = False
        self._turn, self.until_look = 0, LOOKS[0]
        if self._asleep:
            self._rouse([*self._asleep])

    def look(self, bodies: Iterable[Body], restless: Collection[Body]) -> None:
        """Look which bodies rest, and let those sleep that have rested long enough.

        Args:
            bodies: all.
            restless: those that must not sleep.
        """
        passed = LOOKS[self._turn]
        self._turn = (self._turn + 1) % len(LOOKS)
        self.until_look = LOOKS[self._turn]
        for body in bodies:
            if not body.masses:
                continue
            moves = body in restless or any(
                target and limit for target, limit in body.motors.values()
            )
            for number in body.masses:
                if moves or not self._is_slow(number, body.indices.get(number)):
                    self._rested[number] = 0
                    if number in self._asleep:  # it was touched by something that moves
                        del self._asleep[number]
                        self._set([number], _WAKE)
                else:
                    self._rested[number] += passed
        tired = [number for number, rested in self._rested.items() if rested >= self._needed]
        self.is_complete = len(tired) == len(self._rested)
        if not self.is_complete:
            # PyBullet computes no reactions of the joints of sleepers.
            busy = {number for number, _ in self.measured}
            tired = [one for one in tired if one not in self._asleep and one not in busy]
            self._asleep.update(dict.fromkeys(tired))
            self._set(tired, _SLEEP)

    def save_state(self) -> tuple[Any, ...]:
        """Return the state for `restore_state`."""
        return (dict(self._rested), [*self._asleep], self.is_complete, self._turn, self.until_look)

    def restore_state(self, saved: tuple[Any, ...]) -> None:
        """Restore the state of a note; the bodies must be the same, and awake in PyBullet."""
        rested, asleep, self.is_complete, self._turn, self.until_look = saved
        self._rested, self._asleep = dict(rested), dict.fromkeys(asleep)
        self._set(asleep, _SLEEP)

    def _is_slow(self, number: int, joints: list[int] | None) -> bool:
        (x, y, z), (u, v, w) = pybullet.getBaseVelocity(number, self._client)
        squares = x * x + y * y + z * z + u * u + v * v + w * w
        if joints:
            states = pybullet.getJointStates(number, joints, self._client)
            squares += sum(state[1] * state[1] for state in states)
        return bool(squares < SLOW * SLOW)

    def _island(self, number: int) -> list[int]:
        """Return the sleepers that rest on each other with one of them."""
        touching: dict[int, set[int]] = {}
        for point in pybullet.getContactPoints(physicsClientId=self._client):
            touching.setdefault(point[1], set()).add(point[2])
            touching.setdefault(point[2], set()).add(point[1])
        found, ahead = {number: None}, [number]
        while ahead:
            for other in sorted(touching.get(ahead.pop(), ())):
                if other in self._asleep and other not in found:
                    found[other] = None
                    ahead.append(other)
        return [*found]

    def _rouse(self, numbers: Iterable[int]) -> None:
        """Wake sleepers, so that they move in the next step already."""
        numbers = [*numbers]
        for number in numbers:
            self._rested[number] = 0
            del self._asleep[number]
        self._set(numbers, _WAKE)
        self._make_void_step()

    def _set(self, numbers: Iterable[int], state: int) -> None:
        for number in numbers:
            _set_activation(number, state, self._client)


def rest_for_good(number: int, client: int) -> None:
    """Let a body of PyBullet sleep that never moves by itself: a step then leaves it out."""
    _set_activation(number, _SLEEP, client)


def wake(number: int, client: int) -> None:
    """Wake a body of PyBullet, with effect after its next step."""
    _set_activation(number, _WAKE, client)


def _set_activation(number: int, state: int, client: int) -> None:
    pybullet.changeDynamics(
        number, -1, sleepThreshold=SLOW * SLOW, activationState=state, physicsClientId=client
    )
