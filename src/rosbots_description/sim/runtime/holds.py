"""Models that are held at rest."""

from collections.abc import Callable

from ..core import Pose, SimClock, Twist
from .model import Model
from .scheduler import NEVER, Hook


class Holds(Hook):
    """Puts models back to their poses in every step, at rest, whatever acts on them."""

    def __init__(self, clock: SimClock) -> None:
        self._clock = clock
        self._held: dict[Model, tuple[Pose, Callable[[], bool]]] = {}

    def hold(self, model: Model, pose: Pose, lasts: Callable[[], bool]) -> None:
        """Hold a model at a pose in the world from now on, in place of an earlier pose of its own.

        Args:
            lasts: called once a step; the model is released when it returns False.
        """
        self._held[model] = pose, lasts
        _place(model, pose)
        self._set_due()

    def release(self, model: Model) -> None:
        """Let a model move again, if it is held."""
        self._held.pop(model, None)
        self._set_due()

    def clear(self) -> None:
        """Let all models move again."""
        self._held.clear()
        self._set_due()

    def before_step(self) -> None:
        """Place what is still held."""
        self._held = {model: hold for model, hold in self._held.items() if hold[1]()}
        for model, (pose, _) in self._held.items():
            _place(model, pose)
        self._set_due()

    def _set_due(self) -> None:
        self.due = self._clock.steps + 1 if self._held else NEVER


def _place(model: Model, pose: Pose) -> None:
    model.set_pose(pose)
    if not model.static:
        model.set_twist(Twist())
