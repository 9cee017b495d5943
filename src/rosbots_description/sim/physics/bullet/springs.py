"""Springs and dampers of joints, limited to what is stable at the step size.

With step size dt, springs of stiffness k conserve energy and dampers d do not overshoot as long as
sum(dt^2 k c) <= 1 and sum(dt d c) <= 1 over the joints of a body, where c is the acceleration of a
joint per unit of effort. Beyond that, the greatest values are reduced.
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
        # Bodies with damped joints, whose velocities PyBullet samples once per call.
        self.damped: set[int] = set()

    def __bool__(self) -> bool:
        """Tell whether there are any springs."""
        return bool(self._springs)

    def set_step_size(self, step_size: float) -> None:
        """Set the step size [s], which limits stiffness and damping."""
        self._step_size = step_size
        self.add(self._bodies)

    def add(self, bodies: dict[int, Masses]) -> None:
        """Add bodies, given by PyBullet's numbers."""
        for number, masses in bodies.items():
            if not any(masses.stiffness) and not any(masses.damping):
                continue
            self._bodies[number] = masses
            if any(masses.damping):
                self.damped.add(number)
            stiffness = followed_stiffness(masses, self._step_size)
            sprung = [i for i, value in enumerate(stiffness) if value]
            if sprung:
                self._springs[number] = (
                    [masses.joints[i] for i in sprung],
                    [stiffness[i] for i in sprung],
                    [masses.reference[i] for i in sprung],
                )
            for index, damping in zip(
                masses.joints, followed_damping(masses, self._step_size), strict=True
            ):
                pybullet.changeDynamics(
                    number, index, jointDamping=damping, physicsClientId=self._client
                )

    def remove(self, numbers: Iterable[int]) -> None:
        """Remove bodies."""
        for number in numbers:
            self._bodies.pop(number, None)
            self._springs.pop(number, None)
            self.damped.discard(number)

    def clear(self) -> None:
        """Remove all bodies."""
        self.remove(list(self._bodies))

    def apply(self) -> None:
        """Apply the springs' efforts to the joints for the next step."""
        for number, (joints, stiffness, reference) in self._springs.items():
            states = pybullet.getJointStates(number, joints, self._client)
            pybullet.setJointMotorControlArray(
                number,
                joints,
                pybullet.TORQUE_CONTROL,
                forces=[
                    k * (rest - state[0])
                    for k, rest, state in zip(stiffness, reference, states, strict=True)
                ],
                physicsClientId=self._client,
            )


def compliance(joint: JointSpec, child: LinkSpec, parent: LinkSpec | None) -> float:
    """Return the acceleration of a joint per unit of effort [1/(kg m^2) or 1/kg].

    Only the two links of the joint are considered, which gives an upper bound: other links add
    inertia.

    Args:
        parent: the parent link, None if it never moves.
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
    """Return the stiffness of a body's springs, limited for the step size [s]."""
    return _followed(masses.stiffness, masses.compliance, step_size**2)


def followed_damping(masses: Masses, step_size: float) -> tuple[float, ...]:
    """Return the damping of a body's joints, limited for the step size [s]."""
    return _followed(masses.damping, masses.compliance, step_size)


def _followed(
    values: Sequence[float], compliance: Sequence[float], scale: float
) -> tuple[float, ...]:
    """Return the values, the greatest reduced until the sum of value * c * scale is at most 1."""
    units = [1.0 / (c * scale) for c in compliance]
    rest, left, most = 1.0, len(values), math.inf
    for share in sorted(value / unit for value, unit in zip(values, units, strict=True)):
        if share * left > rest:
            most = rest / left
            break
        rest, left = rest - share, left - 1
    return tuple(min(value, most * unit) for value, unit in zip(values, units, strict=True))
