"""What a driven robot drags over the ground: a caster that slides, a skid, its belly.

Friction is limited along the world's axes each (tuning.py). What slides along one of them is held
sideways as by a rail, and a rail behind the wheels turns the robot away from it, faster and faster.
But friction points against the slip: what slides straight on is not held sideways at all. So the
straighter a robot is asked to drive (wheel_pair.py), the less of its friction holds its body along
the axle. Nor is it held back more on a diagonal, where both limits together are 1.4 times as great.

And it gives way by a hair under the robot's weight. Of more than three rigid points nobody can tell
which of them carry, so the load would jump between casters and wheels.
"""

from typing import TYPE_CHECKING

from .body import Hold
from .pose import conjugate, rotate
from .spec import FIXED, ModelSpec
from .wheel import Wheel

if TYPE_CHECKING:
    from .model import Model


class Dragged:
    """The links that move with the one which carries the wheels."""

    def __init__(self, model: 'Model', wheel: Wheel) -> None:
        """Find them.

        Args:
            model: what is driven.
            wheel: one of the wheels; the others turn about the same axle.
        """
        self._model = model
        masses = (link.inertial.mass for link in model.spec.links if link.inertial)
        self._mass = sum(masses)  # [kg]
        self.names = _fixed_to(wheel.joint.spec.parent, model.spec)
        links = [model.spec.link(name) for name in self.names]
        # Each with the direction of the axle in its frame.
        self._links = [
            (link.name, rotate(conjugate(link.pose.orientation), wheel.axle)) for link in links
        ]

    def hold(self, hold: Hold) -> None:
        """Let them hold only these shares of their friction."""
        engine, body = self._model.engine, self._model.body
        for name, axle in self._links:
            engine.let_sink(body, name, self._mass)
            engine.set_hold(body, name, axle, hold)


def _fixed_to(name: str, spec: ModelSpec) -> list[str]:
    """Return the names of the links that fixed joints connect to one, itself first."""
    names = [name]
    for one in names:  # it grows while we walk it
        for joint in spec.joints:
            if joint.type == FIXED and one in (joint.parent, joint.child):
                names += [end for end in (joint.parent, joint.child) if end not in names]
    return [name for name in names if name in {link.name for link in spec.links}]
