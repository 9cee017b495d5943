"""What holds a robot sideways whose tyres slide straight on, or whose motors do not hold it there.

Friction points against the slip: sideways it is to what acts ahead as the slip sideways to the slip
ahead. So what slides straight on is moved aside by very little, and soon comes to rest there.
PyBullet limits friction along the world's axes each (tuning.py) and cannot do so: tyres that slide
and what is dragged hold nothing along the axle there (sliding.py, dragging.py), and the robot is
pushed with what they would hold.
"""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from .clock import NANOSECONDS, SimClock
from .inertia import merge
from .pose import UP, Vector, add, compose, conjugate, cross, dot, relative, rotate, subtract
from .wheel import Wheel

if TYPE_CHECKING:
    from .model import Model

_SLOWEST = 0.02  # [m/s] what slips slower than that holds as if it slipped so fast
_LEVEL = 0.5  # the level part of an axle's direction, at least: of others nobody drives


class SideFriction:
    """Pushes a robot sideways, and turns it, as what slides under it would."""

    def __init__(
        self, model: 'Model', wheels: Sequence[Wheel], dragged: Sequence[str], clock: SimClock
    ) -> None:
        """Describe it.

        Args:
            model: what is driven.
            wheels: about one axle.
            dragged: the names of the links that move with the one which carries the wheels.
        """
        self._model = model
        self._clock = clock
        self._names = [*(wheel.joint.spec.child for wheel in wheels), *dragged]
        self._wheel = wheels[0]
        self._carrier = model.spec.link(self._wheel.joint.spec.parent)  # None: the world
        self.rest()

    def rest(self) -> None:
        """Take note that nothing needs to be held."""
        self._looked_ns: int | None = None  # at the last look, if there was one since

    def look(self, share: float) -> None:
        """Push with what was due since the last look; the first one only takes note.

        Args:
            share: of the friction sideways that the engine leaves to this.
        """
        now_ns, then_ns = self._clock.now_ns, self._looked_ns
        self._looked_ns = now_ns
        if self._carrier is None:
            return
        if then_ns is None:
            links = self._model.spec.links
            self._whole = merge([(link.pose, link.inertial) for link in links if link.inertial])
        elif share > 0.0:
            self._push(share * (now_ns - then_ns) / NANOSECONDS)

    def _push(self, seconds: float) -> None:
        """Give the robot within one step what it would be held with in so much time."""
        pose, (linear, angular) = self._model.links[self._carrier.name].state()
        axle = rotate(conjugate(self._carrier.pose.orientation), self._wheel.axle)
        x, y, _ = rotate(pose.orientation, axle)
        level = math.hypot(x, y)
        if level < _LEVEL:
            return  # it lies on its side
        aside = (x / level, y / level, 0.0)
        centre = compose(pose, relative(self._whole.pose, self._carrier.pose)).position
        moves = dot(add(linear, cross(angular, subtract(centre, pose.position))), aside)
        damping = (0.0, 0.0, 0.0)
        for name in self._names:
            damping = add(damping, self._damping(name, centre, aside))
        moves_less, turns_less = self._stopped(moves, angular[2], damping, seconds)
        per_step = NANOSECONDS / self._clock.step_ns  # [1/s]
        force = -self._whole.mass * moves_less * per_step
        torque = (0.0, 0.0, -self._whole.izz * turns_less * per_step)
        self._model.engine.push(
            self._model.body,
            self._carrier.name,
            tuple(force * part for part in aside),
            torque,
            centre,
        )

    def _stopped(
        self, moves: float, turns: float, damping: Vector, seconds: float
    ) -> tuple[float, float]:
        """Return how much of its motion the robot loses in so much time [m/s], [rad/s].

        Args:
            moves: sideways [m/s].
            turns: about the vertical [rad/s].
            damping: as `_damping` returns it, of all that holds.
            seconds: the time [s].
        """
        # By the motion that is left at the end, not by that at the beginning: whatever holds,
        # nothing is pushed back. Two linear equations, by Cramer's rule.
        a, b, c = (seconds * one for one in damping)
        force, torque = a * moves + b * turns, b * moves + c * turns
        mass, inertia = self._whole.mass + a, self._whole.izz + c
        determinant = mass * inertia - b * b
        return (
            (force * inertia - torque * b) / determinant,
            (torque * mass - force * b) / determinant,
        )

    def _damping(self, name: str, centre: Vector, aside: Vector) -> Vector:
        """Return with what a link holds the robot.

        That is the force per speed sideways [N s/m], the force per turning, which is the torque per
        speed, too [N s], and the torque per turning [N m s].

        Args:
            name: of the link.
            centre: the robot's centre of mass in the world [m].
            aside: the level direction along the axle, a unit vector in the world.
        """
        engine, body = self._model.engine, self._model.body
        ahead = cross(aside, UP)
        pose, (linear, angular) = self._model.links[name].state()
        damping = (0.0, 0.0, 0.0)
        for contact in engine.contacts(body, name):
            slip = add(linear, cross(angular, subtract(contact.place, pose.position)))
            speed = math.hypot(dot(slip, ahead), dot(slip, aside))
            holds = abs(dot(contact.friction, ahead)) / max(speed, _SLOWEST)
            arm = dot(subtract(contact.place, centre), ahead)  # turning moves it aside by that
            damping = add(damping, (holds, holds * arm, holds * arm * arm))
        return damping
