"""A last line of defence: what no longer moves by finite numbers is taken out of harm's way."""

from typing import TYPE_CHECKING

from .scheduler import Hook

if TYPE_CHECKING:
    from .world import World

PERIOD = 100  # steps between two looks: soon enough that nobody falls far through a broken ground


class DivergenceWatchdog(Hook):
    """Looks at all models now and then and has the world rebuilt when one has diverged.

    The world is rebuilt, too, when deleted models have left too much behind in the engine.

    Numbers that are not finite spread inside the engine: other models fall through the ground, even
    after the cause is deleted. So the engine is built anew, the others going on as they were.
    """

    def __init__(self, world: 'World') -> None:
        self._world = world
        self.look_soon()

    def before_step(self) -> None:
        """Rebuild the world if a model has diverged."""
        diverged = [model for model in self._world.models.values() if model.has_diverged()]
        if diverged or self._world.engine.needs_rebuild:
            self._world.rebuild(diverged)
        self.due = self._world.clock.steps + PERIOD

    def look_soon(self) -> None:
        """Look in the next step; time or the size of steps has jumped."""
        self.due = self._world.clock.steps + 1
