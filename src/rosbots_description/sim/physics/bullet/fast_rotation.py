"""Conserves the energy of fast rotating bodies, which PyBullet's integration does not.

PyBullet integrates rotation by explicit Euler, whose energy E grows without bound: at angular speed
w by dE/dt of about dt w^2 E. So the speed of all bodies is checked every few steps, and the energy
of fast ones is corrected in each step.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from ...core import Vector, conjugate, rotate
from ...core.arrays import FloatArray
from .body import Masses
from .client import pybullet
from .springs import followed_damping, followed_stiffness

CHECK_STEPS = 20  # steps between two checks of all bodies
# Thresholds of the correction: dt w^2 [1/s] for bodies of several links without contact, and the
# relative energy gain per second for single links.
_FAST, _FAST_GROWTH = 0.01, 2e-4
_CONTACT_FACTOR = 10.0  # factor on both for bodies in contact, such as a robot turning on the spot
_MAX_SLOW_CHECKS = 100  # slow checks in a row that end the correction of a body
# Allowed growth of energy, as a share of the peak kinetic energy. Velocities and positions are half
# a step apart, which makes the computed energy of a body vary by less than this.
_ALLOWED_GROWTH = 0.01
# What changes of a fast body from step to step.
_STATE = 'peak_kinetic', 'energy_limit', 'is_airborne', 'total_energy', 'slow_checks'
_NEXT, _LAST = np.array((1, 2, 0)), np.array((2, 0, 1))  # axes after and before x, y, z


class FastBodies:
    """The fast rotating bodies of one PyBullet world."""

    def __init__(self, client: int) -> None:
        """Work in the world of that PyBullet client, which is empty."""
        self._client = client
        self._bodies: dict[int, Masses] = {}
        self._fast_bodies: dict[int, _FastBody] = {}
        self.set(0.001, (0.0, 0.0, 0.0))

    def set(self, step_size: float, gravity: Vector) -> None:
        """Set step size [s] and gravity [m/s^2]."""
        self._step_size, self._gravity = step_size, gravity
        self._fast_bodies.clear()
        self.until_check = 0  # steps until the next check

    def add(self, bodies: dict[int, Masses]) -> None:
        """Watch these bodies, given by PyBullet's numbers; known ones have other masses now."""
        self._bodies.update(bodies)
        for number in bodies:
            self._fast_bodies.pop(number, None)

    def remove(self, numbers: Iterable[int]) -> None:
        """Stop watching these bodies."""
        for number in numbers:
            self._bodies.pop(number, None)
            self._fast_bodies.pop(number, None)

    def clear(self) -> None:
        """Forget all bodies."""
        self.remove(list(self._bodies))
        self.until_check = 0

    def allow_external_work(self, number: int) -> None:
        """Note that an external force may do work on a body in the next step."""
        body = self._fast_bodies.get(number)
        if body:
            body.energy_limit = None

    def set_in_motion(self, number: int) -> None:
        """Note that the velocity of a body has been set."""
        self.allow_external_work(number)
        self.until_check = 0

    def save_state(self) -> tuple[Any, ...]:
        """Return the state for `restore_state`."""
        return self.until_check, {number: one.state for number, one in self._fast_bodies.items()}

    def restore_state(self, saved: tuple[Any, ...]) -> None:
        """Restore the state of a note; the bodies must be the same."""
        self.until_check, states = saved
        self._fast_bodies.clear()
        for number, state in states.items():
            one = _FastBody(self._client, number, self._bodies[number])
            one.state = state
            self._fast_bodies[number] = one

    def __bool__(self) -> bool:
        """Tell whether any body is corrected in the next step."""
        return bool(self._fast_bodies)

    def update(self) -> None:
        """Find the fast rotating bodies."""
        self.until_check = CHECK_STEPS
        velocity_of, client, step_size = pybullet.getBaseVelocity, self._client, self._step_size
        for number, masses in self._bodies.items():
            velocity = x, y, z = velocity_of(number, client)[1]
            speed = (x * x + y * y + z * z) * step_size
            if masses.unbalanced:
                states = pybullet.getJointStates(number, masses.unbalanced, client)
                speed += sum(state[1] * state[1] for state in states) * step_size
            if speed <= _FAST and number not in self._fast_bodies:
                continue
            fast = speed / _FAST
            if fast > 1.0 and len(masses.parts) == 1 and not masses.joints:
                _, turn = pybullet.getBasePositionAndOrientation(number, client)
                own = rotate(conjugate(turn), velocity)
                fast = energy_growth_rate(masses.parts[0].moments, own, step_size) / _FAST_GROWTH
            self._update_body(number, masses, fast)

    def _update_body(self, number: int, masses: Masses, fast: float) -> None:
        """Record the speed of a body as a multiple of the threshold."""
        body = self._fast_bodies.get(number)
        if body is not None:
            # A free body may speed up again: rotation about the intermediate axis is unstable.
            body.slow_checks = 0 if fast > 1.0 or body.is_airborne else body.slow_checks + 1
            if body.slow_checks > _MAX_SLOW_CHECKS:
                del self._fast_bodies[number]
        elif fast > 1.0:
            body = _FastBody(self._client, number, masses)
            if fast > _CONTACT_FACTOR or not body.bodies_in_contact():
                self._fast_bodies[number] = body

    def after_step(self) -> None:
        """Remove the energy that PyBullet's integration has added."""
        with np.errstate(all='ignore'):  # a model may have diverged
            for body in self._fast_bodies.values():
                body.limit_energy(self._step_size, self._gravity, self._bodies)


class _FastBody:
    """A fast rotating body, whose energy grows by no more than the work done on it.

    Motors and dampers do work; static bodies do none. The work of external forces and of moving
    bodies in contact is unknown: after either, the new energy is accepted. In free flight only the
    energy about the centre of mass is limited, which gravity does not change. The energy stored in
    springs counts.
    """

    def __init__(self, client: int, number: int, masses: Masses) -> None:
        self._client, self._number, self._all = client, number, masses
        base = [part for part in masses.parts if part.link < 0]
        links = [part for part in masses.parts if part.link >= 0]
        self._base = bool(base) and not masses.is_fixed
        parts = (base if self._base else []) + links
        self._indices = [part.link for part in links]
        self._mass = np.array([[part.mass] for part in parts])
        self._whole_mass = _sum(self._mass)
        self._weight = np.array([[part.mass * part.has_weight] for part in parts])
        self._moments = np.array([part.moments for part in parts])
        self.peak_kinetic = 0.0  # greatest kinetic energy so far [J]
        self.energy_limit: float | None = None  # [J]; None: set after the next step
        self.is_airborne, self.total_energy = False, 0.0  # after the last step
        self.slow_checks = 0

    @property
    def state(self) -> tuple[Any, ...]:
        """Return what changes from step to step."""
        return tuple(getattr(self, name) for name in _STATE)

    @state.setter
    def state(self, state: tuple[Any, ...]) -> None:
        for name, value in zip(_STATE, state, strict=True):
            setattr(self, name, value)

    def limit_energy(self, step_size: float, gravity: Vector, moving: Iterable[int]) -> None:
        """Remove energy that the last step added without work."""
        touched = self.bodies_in_contact()
        total, own, kinetic, drift = self._energy(step_size, gravity)
        self.peak_kinetic = max(self.peak_kinetic, kinetic)
        slack = _ALLOWED_GROWTH * self.peak_kinetic
        was_airborne, self.is_airborne = self.is_airborne, not (touched or self._all.is_fixed)
        stays_airborne = was_airborne and self.is_airborne
        if self.energy_limit is None or not touched.isdisjoint(moving):
            self.energy_limit = slack + (own if self.is_airborne else total)
        else:
            if was_airborne and touched:
                self.energy_limit = self.total_energy
            self.energy_limit += self._work(step_size)
            excess = min(kinetic, (own if stays_airborne else total) - self.energy_limit)
            if excess > 0.0:
                self._scale_velocities((1.0 - excess / kinetic) ** 0.5, drift)
                total, own = total - excess, own - excess
            if touched:
                self.energy_limit = min(self.energy_limit, total + slack)
            elif self.is_airborne and not was_airborne:
                self.energy_limit = own
        self.total_energy = total

    def _energy(self, step_size: float, gravity: Vector) -> tuple[float, float, float, FloatArray]:
        """Return three energies [J], and the velocity of the centre of mass [m/s].

        The energies are: total; without height and velocity of the centre of mass; and the kinetic
        part of the latter. Positions are taken at the middle of the last step, to match the
        velocities.
        """
        states = pybullet.getLinkStates(self._number, self._indices, 1, 1, self._client)
        rows = [(state[0], state[1], state[6], state[7]) for state in states]
        if self._base:
            pose = pybullet.getBasePositionAndOrientation(self._number, self._client)
            rows.insert(0, (*pose, *pybullet.getBaseVelocity(self._number, self._client)))
        places, turns, linear, angular = (np.array(column) for column in zip(*rows, strict=True))
        turning = _rotated_back(turns, angular)
        middle = places - 0.5 * step_size * linear
        energy = -_sum(self._weight * middle * gravity)
        drift = np.zeros(3)
        if not self._all.is_fixed:
            drift = np.add.reduce(self._mass * linear) / self._whole_mass
            energy += 0.5 * self._whole_mass * _sum(drift * drift)
        linear = linear - drift
        kinetic = 0.5 * (
            _sum(self._mass * linear * linear) + _sum(self._moments * turning * turning)
        )
        own = kinetic + self._spring_energy(step_size)
        return energy + own, own, kinetic, drift

    def _spring_energy(self, step_size: float) -> float:
        """Return the energy stored in joint springs [J]."""
        if not any(self._all.stiffness):
            return 0.0
        states = pybullet.getJointStates(self._number, self._all.joints, self._client)
        return float(
            sum(
                0.5 * stiffness * (state[0] - 0.5 * step_size * state[1] - reference) ** 2
                for state, stiffness, reference in zip(
                    states,
                    followed_stiffness(self._all, step_size),
                    self._all.reference,
                    strict=True,
                )
            )
        )

    def _work(self, step_size: float) -> float:
        """Return the work of motors and dampers in the last step [J]."""
        if not self._all.joints:
            return 0.0
        states = pybullet.getJointStates(self._number, self._all.joints, self._client)
        pairs = zip(states, followed_damping(self._all, step_size), strict=True)
        return step_size * float(
            sum(speed * (effort - damping * speed) for (_, speed, _, effort), damping in pairs)
        )

    def bodies_in_contact(self) -> set[int]:
        """Return the numbers of the bodies that touch this one."""
        points = pybullet.getContactPoints(self._number, physicsClientId=self._client)
        return {point[2] for point in points} - {self._number}

    def _scale_velocities(self, share: float, drift: FloatArray) -> None:
        """Scale all velocities relative to the centre of mass by `share`."""
        if self._base:
            linear, angular = pybullet.getBaseVelocity(self._number, self._client)
            linear = drift + share * (np.array(linear) - drift)
            angular = share * np.array(angular)
            pybullet.resetBaseVelocity(
                self._number, linear.tolist(), angular.tolist(), physicsClientId=self._client
            )
        if self._all.joints:
            states = pybullet.getJointStates(self._number, self._all.joints, self._client)
            pybullet.resetJointStatesMultiDof(
                self._number,
                self._all.joints,
                [[state[0]] for state in states],
                [[share * state[1]] for state in states],
                physicsClientId=self._client,
            )


def energy_growth_rate(moments: Vector, velocity: Vector, step_size: float) -> float:
    """Return the relative energy gain of a free body by explicit Euler [1/s].

    With Euler's equations w' = -I^-1 (w x I w) it is dt (w' I w') / (w I w).

    Args:
        moments: principal moments of inertia [kg m^2].
        velocity: angular velocity along the principal axes [rad/s].
    """
    (a, b, c), (x, y, z) = moments, velocity
    energy = a * x * x + b * y * y + c * z * z
    if energy <= 0.0 or min(moments) <= 0.0:
        return 0.0
    torque = ((b - c) * y * z, (c - a) * z * x, (a - b) * x * y)
    return step_size * sum(t * t / i for t, i in zip(torque, moments, strict=True)) / energy


def _rotated_back(turns: FloatArray, vectors: FloatArray) -> FloatArray:
    """Return vectors (n, 3) rotated by the inverse of quaternions (n, 4)."""
    own, w = -turns[:, :3], turns[:, 3:]
    twice = 2.0 * _cross(own, vectors)
    return vectors + w * twice + _cross(own, twice)


def _cross(one: FloatArray, other: FloatArray) -> FloatArray:
    """Return the cross products of vectors (n, 3), to the last bit as numpy's, which is slow."""
    a, b = one.take(_NEXT, 1), other.take(_LAST, 1)
    return a * b - one.take(_LAST, 1) * other.take(_NEXT, 1)


def _sum(numbers: FloatArray) -> float:
    """Return the sum of all numbers, as the method `sum` to the last bit, in half the time."""
    return float(np.add.reduce(numbers, None))
