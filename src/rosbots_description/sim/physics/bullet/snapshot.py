"""Snapshots of one PyBullet world, with bit-identical continuation.

PyBullet's saved state has poses, velocities and contact points. Other state affects the last bits
of the motion: rounding of orientations, the order of overlapping pairs, stale pairs that are not
yet dropped, applied forces. So taking a snapshot and restoring it bring all of this into the same
state: PyBullet sorts the pairs from the first snapshot on, and all bodies are moved apart for a
moment. What PyBullet does not save, such as motors, is recorded separately.

For bodies of several shapes PyBullet mixes up the owners of contact points, so that a snapshot
changes the motion of the article's robot by up to 0.1 um/step. Bodies of one shape are unaffected.
"""

import weakref
from collections.abc import Callable, Sequence
from typing import Any

from ...core import SimError
from .body import Body
from .client import pybullet
from .sleep import rest_for_good, wake

# A collision detection drops a tenth of the stale pairs, at least one: 80 of them drop 4000.
_PASSES = 80
_SPACING = 1e4  # [m] distance between bodies while stale pairs are dropped
_NO_ROTATION = (0.0, 0.0, 0.0, 1.0)
_NEGLIGIBLE_EFFORT = 1e-300  # [N m or N]

Joints = Sequence[tuple[int, int]]  # by PyBullet's body and index


class BulletSnapshot:
    """State of a PyBullet world and more of the engine; bodies are compared by identity."""

    def __init__(
        self, state: int, bodies: Sequence[Body], idle: Joints, engine_state: tuple[Any, ...]
    ) -> None:
        self.state, self.bodies, self.idle = state, tuple(bodies), idle
        self.engine_state = engine_state


class Snapshots:
    """The snapshots of one PyBullet world."""

    def __init__(self, client: int) -> None:
        """Work in the world of that PyBullet client."""
        self._client = client
        self._states: set[int] = set()

    def clear(self) -> None:
        """Drop all snapshots, before PyBullet is reset or disconnected."""
        for state in self._states:
            pybullet.removeState(state, physicsClientId=self._client)
        self._states.clear()  # finalizers of live snapshots have nothing left to free
        self._states = set()

    def take(
        self,
        bodies: Sequence[Body],
        idle: Joints,
        save_state: Callable[[], tuple[Any, ...]],
    ) -> BulletSnapshot:
        """Return a snapshot.

        Args:
            bodies: all, which must exist when it is restored.
            idle: joints whose motors are off.
            save_state: returns the state of the engine that PyBullet does not save.
        """
        client = self._client
        pybullet.setPhysicsEngineParameter(deterministicOverlappingPairs=1, physicsClientId=client)
        state = pybullet.saveState(physicsClientId=client)
        snapshot = BulletSnapshot(state, bodies, idle, save_state())
        self._states.add(snapshot.state)
        weakref.finalize(snapshot, _drop, self._states, snapshot.state, client).atexit = False
        self._restore(snapshot)
        return snapshot

    def require(self, snapshot: BulletSnapshot, bodies: Sequence[Body]) -> None:
        """Raise a `SimError` if the bodies are not those of a snapshot."""
        same = len(bodies) == len(snapshot.bodies) and all(
            a is b for a, b in zip(bodies, snapshot.bodies, strict=True)
        )
        if not same or snapshot.state not in self._states:
            raise SimError(
                'the snapshot is of other models: none may be added, removed or changed '
                'between taking a snapshot and going back to it; take a new one'
            )

    def restore(self, snapshot: BulletSnapshot) -> tuple[Any, ...]:
        """Restore PyBullet's part of a snapshot, and return the engine's own."""
        self._restore(snapshot)
        return snapshot.engine_state

    def _restore(self, snapshot: BulletSnapshot) -> None:
        client, put = self._client, pybullet.resetBasePositionAndOrientation
        moving = [number for body in snapshot.bodies for number in body.masses]
        numbers = [number for body in snapshot.bodies for number in body.bodies]
        static = sorted({*numbers} - {*moving})
        pybullet.restoreState(stateId=snapshot.state, physicsClientId=client)
        # A motor that was switched off still reports its last effort.
        self._set_effort(snapshot.idle, _NEGLIGIBLE_EFFORT)
        for number in static:
            wake(number, client)  # else its bounding box stays where it was
        for attempt in range(_PASSES):
            for i, number in enumerate(moving if attempt < 2 else moving[:1]):
                # PyBullet drops pairs only after something has moved.
                position = (_SPACING * (i + 1), _SPACING * (1 + attempt % 2), _SPACING)
                put(number, position, _NO_ROTATION, client)
                if not attempt:
                    wake(number, client)
            if attempt:
                pybullet.performCollisionDetection(client)
            else:
                pybullet.stepSimulation(client)  # clears applied forces
        for number in static:
            rest_for_good(number, client)
        self._set_effort(snapshot.idle, 0.0)
        pybullet.restoreState(stateId=snapshot.state, physicsClientId=client)

    def _set_effort(self, joints: Joints, effort: float) -> None:
        for joint in joints:
            pybullet.setJointMotorControl2(
                *joint, pybullet.VELOCITY_CONTROL, force=effort, physicsClientId=self._client
            )


def _drop(states: set[int], state: int, client: int) -> None:
    """Free a state in PyBullet after its last reference is gone."""
    if state in states:
        states.discard(state)
        pybullet.removeState(state, physicsClientId=client)
