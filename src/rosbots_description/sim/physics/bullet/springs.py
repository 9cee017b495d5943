"""Springs and dampers of joints, as strong as the steps can follow.

In steps of dt springs of stiffness k keep the energy that they are given, and dampers d turn no
motion round, as long as the sums over a body of dt^2 k c and of dt d c are at most 1; c is how much
a joint is accelerated by a unit of effort. Of stronger ones the strongest act as if they were less.
"""

import math
from collections.abc import Iterable, Sequence

import numpy as np

from ...core import NO_ROTATION, compose, rotate
from ...description import PRISMATIC, JointSpec, LinkSpec
from ...description.inertia import mobility
from .body import Masses
from .client import pybullet


class Springs:
    """The springs in the joints of one PyBullet world."""

    def __init__(self, client: int) -> None:
        """Work in the world of that PyBullet client, which is empty."""
        self._client = client
        self._step_size = 0.001
        self._bodies: dict[int, Masses] = {}
        # By body: its joints with springs, their stiffness and reference.
        self._springs: dict[int, tuple[list[int], list[float], list[float]]] = {}

    def __bool__(self) -> bool:
        """Tell whether there are any."""
        return bool(self._springs)

    @property
    def has_dampers(self) -> bool:
        """Whether joints are damped: PyBullet takes their velocities at the begin of each call."""
        return any(any(masses.damping) for masses in self._bodies.values())

    def set_step_size(self, step_size: float) -> None:
        """Simulate in steps of that size [s] from now on."""
        self._step_size = step_size
        self.add(self._bodies)

    def add(self, bodies: dict[int, Masses]) -> None:
        """Look after these bodies from now on, by PyBullet's numbers."""
        for number, masses in bodies.items():
            if not any(masses.stiffness) and not any(masses.damping):
                continue
            self._bodies[number] = masses
            stiffness = followed_stiffness(masses, self._step_size)
            sprung = [i for i, value in enumerate(stiffness) if value]
            if sprung:
                self._springs[number] = (
                    [masses.joints[i] for i in sprung], [stiffness[i] for i in sprung],
                    [masses.reference[i] for i in sprung],
                )
            for index, damping in zip(
                masses.joints, followed_damping(masses, self._step_size), strict=True
            ):
                pybullet.changeDynamics(
                    number, index, jointDamping=damping, physicsClientId=self._client
                )

    def forget(self, numbers: Iterable[int]) -> None:
        """Look after these bodies no more."""
        for number in numbers:
            self._bodies.pop(number, None)
            self._springs.pop(number, None)

    def clear(self) -> None:
        """Forget all bodies."""
        self.forget(list(self._bodies))

    def push(self) -> None:
        """Push the joints in the next step as their springs do."""
        for number, (joints, stiffness, reference) in self._springs.items():
            states = pybullet.getJointStates(number, joints, self._client)
            pybullet.setJointMotorControlArray(
                number, joints, pybullet.TORQUE_CONTROL,
                forces=[k * (rest - state[0])
                        for k, rest, state in zip(stiffness, reference, states, strict=True)],
                physicsClientId=self._client,
            )


def compliance(joint: JointSpec, child: LinkSpec, parent: LinkSpec | None) -> float:
    """Return how much a joint is accelerated by a unit of effort [1/(kg m^2) or 1/kg].

    So it is, at most, if there were only its two links: all that they are tied to makes them more
    inert.

    Args:
        parent: the link on the other side, None where that never moves.
    """
    frame = compose(child.pose, joint.pose)
    along = np.array(rotate(frame.orientation, joint.axis))
    turns = joint.type != PRISMATIC
    motion = np.concatenate((along * turns, along * (not turns)))
    fixed = mobility(parent, frame.position, NO_ROTATION) if parent else np.zeros((6, 6))
    found = []
    for quarter in range(4 if turns and parent else 1):
        half = quarter * math.pi / 4.0
        turn = (*(along * math.sin(half)), math.cos(half))
        both = fixed + mobility(child, frame.position, turn)
        found.append(1.0 / float(motion @ np.linalg.solve(both, motion)))
    return max(found)


def followed_stiffness(masses: Masses, step_size: float) -> tuple[float, ...]:
    """Return how stiff the springs of a body are in steps of that size [s]."""
    return _followed(masses.stiffness, masses.compliance, step_size**2)


def followed_damping(masses: Masses, step_size: float) -> tuple[float, ...]:
    """Return how strong the dampers of a body are in steps of that size [s]."""
    return _followed(masses.damping, masses.compliance, step_size)


def _followed(
    values: Sequence[float], compliance: Sequence[float], scale: float
) -> tuple[float, ...]:
    """Return the values, the greatest less where their products with the others would exceed 1."""
    units = [1.0 / (c * scale) for c in compliance]
    rest, left, most = 1.0, len(values), math.inf
    for share in sorted(value / unit for value, unit in zip(values, units, strict=True)):
        if share * left > rest:
            most = rest / left
            break
        rest, left = rest - share, left - 1
    return tuple(min(value, most * unit) for value, unit in zip(values, units, strict=True))
