"""A driven wheel: a motor, a tyre that creeps, and what the motor side sees of it.

A tyre that passes on a force F under a load N rolls slower than its hub turns, by a share of the
speed that grows with F / N (linear creep; Pacejka, Tyre and Vehicle Dynamics, ch. 3). PyBullet's
contacts never creep, so the creep sits between motor and wheel here: the motor is asked for the
hub's speed, the joint turns at the tyre's, and position and velocity are reported for the hub.
"""

from typing import TYPE_CHECKING

from .pose import Vector, compose, rotate
from .spec import Cylinder, LinkSpec, Sphere

if TYPE_CHECKING:
    from .model import Joint

# Creep stiffness: F / N at which the creep would be 100 %. Rubber on a road has 10 to 20; with this
# value the article's robot loses as much speed as in Gazebo, whose contacts slip by trembling.
CREEP_STIFFNESS = 12.5


class Wheel:
    """A wheel joint with a motor; positive turns drive forward.

    `radius` [m] is that of the shape that touches the ground, None where that is no single
    cylinder or ball; such a wheel does not creep.
    """

    def __init__(self, joint: 'Joint', torque: float) -> None:
        """Describe the wheel; `release` takes over its motor.

        Args:
            joint: what turns.
            torque: the most the motor gives [N m].
        """
        self.joint = joint
        self.name = joint.name
        self.radius = _radius(self._link())
        self._torque = torque
        self._creep = 0.0  # hub speed minus tyre speed [rad/s]
        self._lead = 0.0  # how far the hub has turned more than the tyre [rad]

    def release(self) -> None:
        """Forget speed and way; the motor holds the wheel."""
        self._creep = self._lead = 0.0
        self.joint.set_motor(0.0, self._torque)

    def rest(self) -> None:
        """Take note that the wheel stands still; how far it has turned, and the motor, stay."""
        self._creep = 0.0

    @property
    def position(self) -> float:
        """Return how far the hub has turned [rad]."""
        return self.joint.position + self._lead

    @property
    def velocity(self) -> float:
        """Return the speed of the hub [rad/s]."""
        return self.joint.velocity + self._creep

    def drive(self, velocity: float, elapsed: float) -> None:
        """Turn the hub at `velocity` [rad/s] from now on.

        Args:
            elapsed: time since the last call [s], for which the last creep counts.
        """
        self._lead += self._creep * elapsed
        self._creep = self._creep_share() * velocity
        self.joint.set_motor(velocity - self._creep, self._torque)

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

    def _creep_share(self) -> float:
        """Return the share of the hub's speed that creep takes now; negative while braking."""
        load = self.joint.normal_force() if self.radius else 0.0
        if load <= 0.0:
            return 0.0
        speed, effort = self.joint.velocity, self.joint.effort
        share = min(1.0, abs(effort) / self.radius / load) / CREEP_STIFFNESS
        return share if speed * effort > 0.0 else -share

    def _link(self) -> LinkSpec:
        return self.joint.model.spec.link(self.joint.spec.child)


def _radius(link: LinkSpec) -> float | None:
    if len(link.collisions) != 1 or not isinstance(link.collisions[0].geometry, Cylinder | Sphere):
        return None
    return link.collisions[0].geometry.radius
