"""Snapshots of one PyBullet world that it goes on from bit for bit.

PyBullet's own save keeps poses, velocities and contact points. The rest would let the same state
move on in other bits: last bits of turns, the order of pairs that may touch, pairs that are apart
by now and not dropped yet, pushes. So taking a snapshot and going back to it both bring that into
one order: PyBullet sorts pairs from the first snapshot on, and all bodies are apart for a moment.
What PyBullet never gives back, such as motors, is noted beside.

Of bodies of several shapes PyBullet mixes up whose contact points are whose, so that the robot of
the article moves on by up to 0.1 um/step otherwise than without a snapshot. Single shapes do not,
unless the solver makes other iterations for that robot's motors: their number is common to all.
"""

import weakref
from collections.abc import Callable, Sequence
from typing import Any

from ...core import SimError
from .client import pybullet

# PyBullet drops a tenth of the pairs that are apart at a look, one at least: 80 looks drop 4000.
_LOOKS = 80
_APART = 1e4  # [m] from each other, while pairs are dropped
_NO_TURN = (0.0, 0.0, 0.0, 1.0)
_NEXT_TO_NONE = 1e-300  # [N m or N]

Joints = Sequence[tuple[int, int]]  # by PyBullet's body and index


class BulletSnapshot:
    """The state of a PyBullet world, and notes of what belongs to it; bodies go by identity."""

    def __init__(
        self, state: int, bodies: Sequence[Any], idle: Joints, notes: tuple[Any, ...]
    ) -> None:
        self.state, self.bodies, self.idle, self.notes = state, tuple(bodies), idle, notes


class Snapshots:
    """The snapshots of one PyBullet world."""

    def __init__(self, client: int) -> None:
        """Save the world of that PyBullet client."""
        self._client = client
        self._kept: set[int] = set()

    def clear(self) -> None:
        """Forget all snapshots; PyBullet has done so, too, or is about to."""
        for state in self._kept:
            pybullet.removeState(state, physicsClientId=self._client)
        self._kept.clear()  # what is still held of it has nothing to free any more
        self._kept = set()

    def take(
        self, bodies: Sequence[Any], moving: Sequence[int], idle: Joints,
        note: Callable[[], tuple[Any, ...]],
    ) -> BulletSnapshot:
        """Return a snapshot.

        Args:
            bodies: what has to be there again when it is restored.
            moving: PyBullet's numbers of what moves.
            idle: joints whose motors have no effort.
            note: gives what to return of the state beside PyBullet's.
        """
        client = self._client
        pybullet.setPhysicsEngineParameter(deterministicOverlappingPairs=1, physicsClientId=client)
        snapshot = BulletSnapshot(pybullet.saveState(physicsClientId=client), bodies, idle, note())
        self._kept.add(snapshot.state)
        weakref.finalize(snapshot, _drop, self._kept, snapshot.state, client).atexit = False
        self._put_back(snapshot, moving)
        return snapshot

    def put_back(
        self, snapshot: BulletSnapshot, bodies: Sequence[Any], moving: Sequence[int]
    ) -> tuple[Any, ...]:
        """Restore PyBullet's part of a snapshot, and return the notes.

        Raises:
            SimError: the bodies are not those of the snapshot.
        """
        same = len(bodies) == len(snapshot.bodies) and all(
            a is b for a, b in zip(bodies, snapshot.bodies, strict=True))
        if not same or snapshot.state not in self._kept:
            raise SimError('the snapshot is of other models: none may be added, removed or changed '
                           'between taking a snapshot and going back to it; take a new one')
        self._put_back(snapshot, moving)
        return snapshot.notes

    def _put_back(self, snapshot: BulletSnapshot, moving: Sequence[int]) -> None:
        client, put = self._client, pybullet.resetBasePositionAndOrientation
        pybullet.restoreState(stateId=snapshot.state, physicsClientId=client)
        # A motor without effort goes on reporting what it gave before it had none.
        self._give_effort(snapshot.idle, _NEXT_TO_NONE)
        for look in range(_LOOKS):
            for i, number in enumerate(moving if look < 2 else moving[:1]):
                # PyBullet drops pairs only after something has moved.
                put(number, (_APART * (i + 1), _APART * (1 + look % 2), _APART), _NO_TURN, client)
            if look:
                pybullet.performCollisionDetection(client)
            else:
                pybullet.stepSimulation(client)  # which ends pushes
        self._give_effort(snapshot.idle, 0.0)
        pybullet.restoreState(stateId=snapshot.state, physicsClientId=client)

    def _give_effort(self, joints: Joints, effort: float) -> None:
        for joint in joints:
            pybullet.setJointMotorControl2(
                *joint, pybullet.VELOCITY_CONTROL, force=effort, physicsClientId=self._client)


def _drop(kept: set[int], state: int, client: int) -> None:
    """Let PyBullet forget a state that nobody can ask for any more."""
    if state in kept:
        kept.discard(state)
        pybullet.removeState(state, physicsClientId=client)
