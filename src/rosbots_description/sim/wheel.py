"""A driven wheel: a motor that gives way, a tyre that creeps, and what the motor side sees of it.

A tyre that passes on a force creeps: its rim is faster than the ground passes under it. And the
motor before it turns a little slower than it is asked to. Gazebo's traces of the article's robot
show by how much (doc/physics.md): at any speed alike, the lag goes with the share of the grip in
use, the creep with its square.

PyBullet's contacts never creep, so the creep sits between motor and wheel here: the motor is asked
for the hub's speed, the joint turns at the tyre's, and position and velocity are reported for the
hub. PyBullet's motors lag by what its solver leaves undone, on one side more than on the other,
which would turn the robot; so each is asked for more or less, until it lags as the force tells.
What the force is, and when to look at it, a WheelPair says.
"""

import math
from typing import TYPE_CHECKING

from .body import Hold
from .clock import NANOSECONDS, SimClock
from .pose import UP, Vector, add, compose, cross, dot, rotate
from .spec import Cylinder, LinkSpec, Sphere
from .surfaces import friction, touching_end

if TYPE_CHECKING:
    from .model import Joint

# At the rim of a wheel whose tyre uses all of its grip, before it slides:
LAG = 0.0125  # how much slower the motor turns than asked [m/s]
# Of that at most so much [m/s]: what lags by 0.01 m/s a drive asks for more and more of, in leaps.
MOST_LAG = 0.0075
CREEP = 0.092  # how much faster the tyre turns than the ground passes [m/s]
# Time in which creep follows the force [s]; a tyre's follows over a length. Without it the force,
# which a rigid contact lets jump from step to step, would shake the wheels.
RELAXATION = 0.1
TRIMMING = 0.5  # time in which the motor comes to its lag [s]; a ramp passes before
TRIM = 1.0  # [rad/s] a motor further from its lag than that is held up by something else
ALL = 0.999  # of its torque: a motor that gives as much cannot do more


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
        self._axis = joint.spec.axis_in_child
        self._torque = torque
        self._clock = clock
        self._asked = 0.0  # hub speed [rad/s]
        self._asked_ns = 0  # since when
        self._trim = 0.0  # what the motor is asked for beyond that [rad/s]
        self._creep = 0.0  # hub speed minus tyre speed [rad/s]
        self._lead = 0.0  # how far the hub had turned more than the tyre at `_noted_ns` [rad]
        self._noted_ns = 0
        self._due = 0.0  # where the hub would be, had it turned as asked since `_noted_ns` [rad]

    def release(self) -> None:
        """Forget speed and way; the motor holds the wheel."""
        self.rest()
        self._lead, self._due = 0.0, self.joint.position
        self.joint.set_motor(0.0, self._torque)

    def rest(self) -> None:
        """Take note that the wheel stands still; how far it has turned, and the motor, stay."""
        self._note()
        self._asked = self._trim = self._creep = 0.0

    @property
    def position(self) -> float:
        """Return how far the hub has turned [rad]."""
        return self.joint.position + self._lead + self._creep * self._since(self._noted_ns)

    @property
    def velocity(self) -> float:
        """Return the speed of the hub [rad/s]."""
        return self.joint.velocity + self._creep

    def ask(self, velocity: float) -> None:
        """Take note of the speed that the hub is to have from now on [rad/s]; `turn` obeys."""
        self._due += self._asked * self._since(self._asked_ns)
        self._asked, self._asked_ns = velocity, self._clock.now_ns

    def turn(self) -> None:
        """Let the motor bring the hub to the speed that was asked for."""
        model = self.joint.model
        model.engine.let_roll(model.body, self.joint.spec.child)
        self.joint.set_motor(self._asked + self._trim - self._creep, self._torque)

    def pull_and_grip(self) -> tuple[float, float]:
        """Return the force [N] with which the motor drives the rim, and the most the tyre holds."""
        if not self.radius:
            return 0.0, 0.0
        return self.joint.effort / self.radius, self.joint.normal_force() * self._grip

    def slip(self) -> float:
        """Return how much faster the rim runs than the ground passes under it [m/s].

        None is known of a wheel of unknown radius: 0.
        """
        if not self.radius:
            return 0.0
        pose, twist = self.joint.model.links[self.joint.spec.child].state()
        axle = rotate(pose.orientation, self._axis)
        ahead = dot(cross(axle, UP), twist.linear)
        return self.joint.velocity * self.radius - ahead

    def strains(self) -> bool:
        """Tell whether the motor gives all it has."""
        return abs(self.joint.effort) >= ALL * self._torque

    def hold(self, hold: Hold) -> None:
        """Let the tyre hold only these shares of its friction."""
        model = self.joint.model
        model.engine.set_hold(model.body, self.joint.spec.child, self._axis, hold)

    def give_way(self, use: float, ahead: float, slides: bool) -> None:
        """Bring creep and lag towards what belongs to a share of the grip in use, -1 to 1.

        A wheel that is asked to stand neither lags nor creeps: a parked robot stays where it is.

        Args:
            ahead: how much farther it has come than its tyre tells since it was looked at last [m].
            slides: what a tyre that slides does to its motor tells nothing: the lag is forgotten.
        """
        if not self._asked:
            use = 0.0
        behind, elapsed = self._note()
        radius = self.radius or math.inf
        steady = CREEP * use * abs(use) / radius
        self._creep += (steady - self._creep) * min(1.0, elapsed / RELAXATION)
        if elapsed <= 0.0:
            return
        if slides:
            missing = -self._trim
        elif not self.strains():
            missing = behind / elapsed - max(-MOST_LAG, min(MOST_LAG, LAG * use)) / radius
        else:
            return
        missing -= ahead / radius / elapsed
        if abs(missing) < TRIM:
            trim = self._trim + missing * min(1.0, elapsed / TRIMMING)
            self._trim = max(-TRIM, min(TRIM, trim))

    def _note(self) -> tuple[float, float]:
        """Note where the hub is; return how far it fell behind since then, and that time.

        The way tells more than the speed, which contacts let jump from step to step.
        """
        elapsed = self._since(self._noted_ns)
        self._lead += self._creep * elapsed
        self._noted_ns = self._clock.now_ns
        self.ask(self._asked)
        position = self.position
        behind, self._due = self._due - position, position
        return behind, elapsed

    def _since(self, then_ns: int) -> float:
        # A difference of whole nanoseconds: the same at any time of day, so the motion is, too.
        return (self._clock.now_ns - then_ns) / NANOSECONDS

    @property
    def axle(self) -> Vector:
        """Return the direction of the axis, in the frame of the model as it was spawned."""
        return rotate(self._link().pose.orientation, self._axis)

    def place_on_axle(self) -> Vector:
        """Return where the touching shape stands along the axle, in the model frame [m].

        It is the shape's middle, projected onto the axle's direction: the distance between the
        places of two parallel wheels is their track.
        """
        link = self._link()
        ax, ay, az = self.axle
        along = dot(self.axle, compose(link.pose, link.collisions[0].pose).position)
        return (along * ax, along * ay, along * az)

    def touches_on_axle(self) -> Vector:
        """Return the same for where that shape touches a floor under the model [m]."""
        link = self._link()
        shape = link.collisions[0]
        if not isinstance(shape.geometry, Cylinder):
            return self.place_on_axle()
        axis = rotate(compose(link.pose, shape.pose).orientation, UP)
        end = touching_end(shape.geometry, axis) * dot(self.axle, axis)
        return add(self.place_on_axle(), tuple(end * part for part in self.axle))

    def _link(self) -> LinkSpec:
        return self.joint.model.spec.link(self.joint.spec.child)


def _radius(link: LinkSpec) -> float | None:
    if len(link.collisions) != 1 or not isinstance(link.collisions[0].geometry, Cylinder | Sphere):
        return None
    return link.collisions[0].geometry.radius


def _grip(link: LinkSpec) -> float:
    return min((friction(collision.surface) for collision in link.collisions), default=0.0)
