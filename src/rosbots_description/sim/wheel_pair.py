"""Two wheels that drive a robot together: what they share on the straight, and what is dragged.

How much a robot turns is the small difference of what its two wheels do. Force and load of each
jump from step to step with the contacts, and a robot whose wheels are asked to run alike would turn
by those jumps. So there both give way by the grip that both together use. In a curve each goes by
its own, and what is dragged holds sideways, too; how far from straight a way is, `bend_of` tells.
"""

import math
from typing import TYPE_CHECKING

from .body import HOLDS_ALL, Body, Hold
from .clock import SimClock
from .dragging import Dragged
from .drifting import Drift
from .pose import yaw_of
from .side_friction import SideFriction
from .sliding import Sliding
from .wheel import Wheel

if TYPE_CHECKING:
    from .model import Model

# In a curve where the speeds of the wheels differ by this share of their sum, they share nothing.
BEND = 0.5
# From the first of these shares of the wheels' grip on, what they drag gives way sideways, and at
# the second it holds nothing there: it would hold the robot for good.
EASES = (0.45, 0.65)
_EASING = 0.1  # of the way to what the grip in use tells, at each look; a ramp passes before
LOOK_NS = 50_000_000  # time between two looks at force and load, half of what steering costs [ns]


class WheelPair:
    """A left and a right wheel about one axle."""

    def __init__(self, model: 'Model', left: Wheel, right: Wheel, clock: SimClock) -> None:
        """Describe them; `release` takes over the motors."""
        self.wheels = (left, right)
        self._model = model
        self._dragged = Dragged(model, left)
        self._sliding = Sliding(self.wheels)
        self._side = SideFriction(model, self.wheels, self._dragged.names, clock)
        self._drift = Drift(model, left, right, clock)
        self._clock = clock
        self._looked_ns = 0
        self._driven: tuple[Body, float, float] | None = None  # what was asked of which body last
        self._eased = 1.0  # share of what it would hold sideways else that what is dragged holds
        self._settled = False  # nothing but a new look would change anything

    def release(self) -> None:
        """Forget speeds and ways; the motors hold the wheels."""
        self.rest()
        for wheel in self.wheels:
            wheel.release()
        self._dragged.hold(HOLDS_ALL)

    def rest(self) -> None:
        """Take note that the wheels stand still."""
        self._looked_ns = self._clock.now_ns
        self._eased = 1.0
        self._settled = False
        for wheel in self.wheels:
            wheel.rest()
        self._sliding.rest()
        self._side.rest()
        self._drift.rest()

    def drive(self, left: float, right: float) -> None:
        """Turn the hubs at these speeds [rad/s] from now on."""
        now_ns = self._clock.now_ns
        looks = now_ns - self._looked_ns >= LOOK_NS
        driven = (self._model.body, left, right)
        if driven == self._driven and self._settled and not looks:
            return
        self._driven = driven
        bend = bend_of(left, right)
        for wheel, speed in zip(self.wheels, (left, right), strict=True):
            wheel.ask(speed)
        if looks:
            self._looked_ns = now_ns
            self._give_way(bend)
        for wheel in self.wheels:
            wheel.turn()
        yaw = yaw_of(self._model.pose.orientation)
        alike = 1.0 / self._model.engine.friction_towards(yaw)
        eased = self._eased if left or right else 1.0  # who stands may be held on a slope
        self._dragged.hold(_hold(bend * eased, alike))
        self._sliding.watch((left, right), _hold(bend, alike))
        # Motors that strain do not hold the heading, either.
        free = self._sliding.slides or any(wheel.strains() for wheel in self.wheels)
        if free:
            self._side.look(1.0 - bend)
        else:
            self._side.rest()
        self._settled = not free

    def _give_way(self, bend: float) -> None:
        """Let wheels lag and creep, and what is dragged let go, as the grip in use tells."""
        pulls, grips = zip(*(wheel.pull_and_grip() for wheel in self.wheels), strict=True)
        both = _share(sum(pulls), sum(grips))
        eases, free = EASES
        in_use = _share(sum(map(abs, pulls)), sum(grips))
        target = min(1.0, max(0.0, (free - in_use) / (free - eases)))
        self._eased += (target - self._eased) * _EASING
        farther = (1.0 - bend) * self._drift.look()
        slides = bend < 1.0 and self._sliding.slides
        ahead = (-farther, farther)
        for wheel, pull, grip, way in zip(self.wheels, pulls, grips, ahead, strict=True):
            wheel.give_way(both + bend * (_share(pull, grip) - both), way, slides)


def bend_of(left: float, right: float) -> float:
    """Return how far from straight two speeds make the way: 0 straight, 1 a curve or at rest.

    It grows with the square: what is dragged in a gentle curve slides hardly sideways.
    """
    difference, straight = abs(right - left), BEND * abs(right + left)
    return (difference / straight) ** 2 if difference < straight else 1.0


def _hold(bend: float, alike: float) -> Hold:
    """Return what holds of that which slides on a way so far from straight.

    The straighter it is, the less holds along the axle, and the nearer is what holds ahead to
    `alike`, the share that makes it as much as at any other heading.
    """
    return Hold(bend, alike + bend * (1.0 - alike)).rounded()


def _share(pull: float, grip: float) -> float:
    """Return the share of a grip [N] that a pull [N] uses, -1 to 1 as it points."""
    return math.copysign(min(1.0, abs(pull) / grip), pull) if grip > 0.0 else 0.0
