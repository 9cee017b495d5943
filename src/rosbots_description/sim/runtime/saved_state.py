"""The complete state of a world at one time, which can be restored any number of times."""

import copy
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from ..core import SimError
from .model_part import ModelPart
from .outputs import Output
from .scheduler import Hook

if TYPE_CHECKING:
    from .world import World


class SavedState:
    """What a world was at one moment: motion, time, forces, what plugins and sensors remember."""

    def __init__(self, world: 'World', hooks: Sequence[Hook]) -> None:
        """Save the state of a world between two runs, and that of its own hooks."""
        self._world = world
        self._models = tuple(world.models.values())
        self._clock, self._time = dict(vars(world.clock)), world.clock.now
        self._physics, self._lights, self._paused = world.physics, dict(world.lights), world.paused
        self._seed = world.seed
        self._snapshot = world.engine.snapshot()
        self._shared = {id(one): one for one in self._find_shared()}
        owners = (*hooks, *self._components())
        self._hooks = [(owner, self._copied(vars(owner))) for owner in owners]
        self._newest = [(output, output.latched) for output in self._outputs()]

    def __repr__(self) -> str:
        """Return its time and models."""
        return f'<{type(self).__name__} at {self._time} s with {_listed(self._models)}>'

    def restore(self, world: 'World') -> None:
        """Restore this state.

        Raises:
            SimError: it is of another world, or the world has other models now.
        """
        if world is not self._world:
            raise SimError('the state was saved in another world; restore it there')
        models = tuple(world.models.values())
        if [*map(id, models)] != [*map(id, self._models)]:
            raise SimError(
                f'the state was saved with the models {_listed(self._models)}, and now there are '
                f'{_listed(models)}; save another one after models have come or gone'
            )
        world.engine.restore(self._snapshot)
        vars(world.clock).update(self._clock)
        world.physics, world.paused, world.seed = self._physics, self._paused, self._seed
        world.lights.clear()
        world.lights.update(self._lights)
        for hook, state in self._hooks:
            vars(hook).clear()
            vars(hook).update(self._copied(state))
        for output, reading in self._newest:
            output.latched = reading
        for part in self._parts():
            part.count_readers()  # the current ones

    def _parts(self) -> Iterator[ModelPart]:
        for model in self._models:
            yield from model.parts

    def _outputs(self) -> Iterator[Output[Any]]:
        for part in self._parts():
            yield from (one for one in part.shared() if isinstance(one, Output))

    def _components(self) -> Iterator[object]:
        for part in self._parts():
            yield from part.components()

    def _copied(self, state: dict[str, Any]) -> dict[str, Any]:
        """Return a deep copy of a hook's own state; shared objects are not copied."""
        return copy.deepcopy(state, dict(self._shared))

    def _find_shared(self) -> Iterator[object]:
        """Yield the shared objects that are reachable from hooks."""
        world = self._world
        yield from (world, world.clock, world.schedule, world.engine)
        for model in self._models:
            yield from (model, model.spec, model.body, *model.links.values())
            yield from model.joints.values()
        for part in self._parts():
            yield from (part, *part.shared(), *part.components())


def _listed(models: Sequence[Any]) -> str:
    return ', '.join(model.name for model in models) or 'none'
