"""A driven wheel: a motor, a tyre that creeps, and what the motor side sees of it.

A tyre that passes on a force creeps: its rim is faster than the ground passes under it. Gazebo's
trace of the article's robot shows by how much: at any speed alike, and with the square of the share
of the grip in use (doc/physics.md). PyBullet's contacts never creep, so the creep sits between
motor and wheel here: the motor is asked for the hub's speed, the joint turns at the tyre's, and
position and velocity are reported for the hub.
"""

import math
from typing import TYPE_CHECKING

from .bullet_description import friction
from .clock import NANOSECONDS, SimClock
from .pose import Vector, compose, rotate
from .spec import Cylinder, LinkSpec, Sphere

if TYPE_CHECKING:
    from .model import Joint

# Creep of a tyre that uses all of its grip [m/s], before it slides.
CREEP = 0.085
# Time in which creep follows the force [s]; a tyre's follows over a length. Without it the force,
# which a rigid contact lets jump from step to step, would shake the wheels.
RELAXATION = 0.1
LOOK = 0.05  # time between two looks at force and load, half of what steering costs [s]


class Wheel:
    """A wheel joint with a motor; positive turns drive forward.

    `radius` [m] is that of the shape that touches the ground, None where that is no single
    cylinder or ball; such a wheel does not creep.
    """

    def __init__(self, joint: 'Joint', torque: float, clock: SimClock) -> None:
        """Describe the wheel; `release` takes over its motor.

        Args:
            joint: what turns.
            torque: the most the motor gives [N m].
            clock: the simulated time.
        """
        self.joint = joint
        self.name = joint.name
        self.radius = _radius(self._link())
        self._grip = _grip(self._link())
        self._torque = torque
        self._clock = clock
        self._creep = 0.0  # hub speed minus tyre speed [rad/s]
        self._lead = 0.0  # how far the hub had turned more than the tyre at `_noted_ns` [rad]
        self._noted_ns = 0

    def release(self) -> None:
        """Forget speed and way; the motor holds the wheel."""
        self.rest()
        self._lead = 0.0
        self.joint.set_motor(0.0, self._torque)

    def rest(self) -> None:
        """Take note that the wheel stands still; how far it has turned, and the motor, stay."""
        self._note_lead()
        self._creep = 0.0

    @property
    def position(self) -> float:
        """Return how far the hub has turned [rad]."""
        return self.joint.position + self._lead + self._creep * self._since_noted()

    @property
    def velocity(self) -> float:
        """Return the speed of the hub [rad/s]."""
        return self.joint.velocity + self._creep

    def drive(self, velocity: float) -> None:
        """Turn the hub at `velocity` [rad/s] from now on."""
        if self._since_noted() >= LOOK:
            elapsed = self._note_lead()
            self._creep += (self._steady_creep() - self._creep) * min(1.0, elapsed / RELAXATION)
        self.joint.set_motor(velocity - self._creep, self._torque)

    def _note_lead(self) -> float:
        """Add up the creep since it was last done; return the time since then [s]."""
        elapsed = self._since_noted()
        self._noted_ns = self._clock.now_ns
        self._lead += self._creep * elapsed
        return elapsed

    def _since_noted(self) -> float:
        # A difference of whole nanoseconds: the same at any time of day, so the motion is, too.
        return (self._clock.now_ns - self._noted_ns) / NANOSECONDS

    def place_on_axle(self) -> Vector:
        """Return where the touching shape stands along the axle, in the model frame [m].

        It is the shape's middle, projected onto the axle's direction: the distance between the
        places of two parallel wheels is their track.
        """
        link = self._link()
        x, y, z = compose(link.pose, link.collisions[0].pose).position
        spec = self.joint.spec
        ax, ay, az = rotate(link.pose.orientation, rotate(spec.pose.orientation, spec.axis))
        along = ax * x + ay * y + az * z
        return (along * ax, along * ay, along * az)

    def _steady_creep(self) -> float:
        """Return the creep [rad/s] that belongs to the present force; it points along the force."""
        load = self.joint.normal_force() * self._grip if self.radius else 0.0
        if load <= 0.0:
            return 0.0
        effort = self.joint.effort
        use = min(1.0, abs(effort) / (self.radius * load))
        return math.copysign(CREEP * use * use / self.radius, effort)

    def _link(self) -> LinkSpec:
        return self.joint.model.spec.link(self.joint.spec.child)


def _radius(link: LinkSpec) -> float | None:
    if len(link.collisions) != 1 or not isinstance(link.collisions[0].geometry, Cylinder | Sphere):
        return None
    return link.collisions[0].geometry.radius


def _grip(link: LinkSpec) -> float:
    return min((friction(collision.surface) for collision in link.collisions), default=0.0)
