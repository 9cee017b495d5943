"""The divergence watchdog: rebuild the world if a pose or velocity is no longer finite."""

from typing import TYPE_CHECKING

from .scheduler import Hook

if TYPE_CHECKING:
    from .world import World

PERIOD = 100  # steps between two checks: models cannot fall far through a diverged ground


class DivergenceWatchdog(Hook):
    """Checks all models periodically, and rebuilds the world if one has diverged.

    It also rebuilds the world if deleted models have leaked too much memory in the engine.

    Non-finite numbers spread inside the engine: other models fall through the ground, even after
    the cause is deleted. A rebuilt engine continues with the states of the other models.
    """

    def __init__(self, world: 'World') -> None:
        self._world = world
        self.check_soon()

    def before_step(self) -> None:
        """Rebuild the world if a model has diverged."""
        diverged = [model for model in self._world.models.values() if model.has_diverged()]
        if diverged or self._world.engine.needs_rebuild:
            self._world.rebuild(diverged)
        self.due = self._world.clock.steps + PERIOD

    def check_soon(self) -> None:
        """Check in the next step; time or step size has jumped."""
        self.due = self._world.clock.steps + 1
