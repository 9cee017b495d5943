"""The world: a clock, a physics engine, models in spawn order, and a schedule of hooks."""

import contextlib
import functools
import logging
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Concatenate, ParamSpec, TypeVar

from ..core import (
    END,
    IDENTITY,
    MAX_COORDINATE,
    Faults,
    ModelError,
    NotFoundError,
    Pose,
    Receiver,
    SimClock,
    Twist,
    reporting_to,
)
from ..description import LightSpec, ModelSpec, PhysicsSettings, WorldSpec
from ..physics import CompiledModel, EngineFactory, make_engine
from .changes import Revisions
from .divergence_watchdog import DivergenceWatchdog
from .external_forces import ExternalForces
from .holds import Holds
from .model import CollisionFrame, Joint, Link, Model
from .model_part import ModelPart
from .nested_model import NestedModel, nested_models
from .part_loading import PartLoader
from .saved_state import SavedState
from .scheduler import Schedule

P = ParamSpec('P')
T = TypeVar('T')

WORLD_FRAMES = ('', 'world', 'map', '/map')
Entity = Model | NestedModel | Link | CollisionFrame


class Listener:
    """Observer of a world, called on the world's own thread; by itself it does nothing."""

    def model_spawned(self, model: Model) -> None:
        """A model was spawned, with its plugins."""

    def model_deleted(self, model: Model) -> None:
        """A model is about to be deleted; its plugins are still loaded."""

    def world_reset(self) -> None:
        """Poses, and perhaps time, were reset."""


def _reporting(
    method: 'Callable[Concatenate[World, P], T]',
) -> 'Callable[Concatenate[World, P], T]':
    """Return a method of a world that hands what is reported in it to the world's faults."""

    @functools.wraps(method)
    def reporting(world: 'World', /, *args: P.args, **kwargs: P.kwargs) -> T:
        with reporting_to(world.faults.add):
            return method(world, *args, **kwargs)

    return reporting


class World:
    """Everything that is simulated. One thread owns it: no method may be called from another.

    `paused` is to be respected by the caller of `run`, which itself ignores it.
    """

    def __init__(
        self,
        physics: PhysicsSettings | None = None,
        make_engine: EngineFactory = make_engine,
        on_fault: Receiver | None = None,
    ) -> None:
        """Open an empty world.

        Args:
            make_engine: makes the physics engine.
            on_fault: see `Faults`.
        """
        self.spec = WorldSpec()  # as it was read; when saved, what nothing here acts on is as there
        self.name, self.scene = self.spec.name, self.spec.scene
        self.physics = physics or PhysicsSettings()
        self.clock = SimClock(self.physics.step_size)
        self.faults = Faults(self.clock, on_fault)
        self.schedule = Schedule()
        self.external_forces = ExternalForces(self.clock)
        self.schedule.add(self.external_forces)
        self.holds = Holds(self.clock)
        self.schedule.add(self.holds)
        self.models: dict[str, Model] = {}
        self.lights: dict[str, LightSpec] = {}
        self.listeners: list[Listener] = []
        self.resources = contextlib.ExitStack()  # of others, which end with the world
        self.paused = False
        self._holders: set[object] = set()  # those who hold physics
        self.strict = False  # with the flaws of Gazebo that a client may rely on
        # Set by who runs it at the pace of the wall clock: then no step waits for what takes long,
        # such as pictures, and these are given out when they are there.
        self.is_paced = False
        self.seed = 0  # of the noise of sensors; any number, from the next reading on
        self.rebuilds = 0  # of the engine, since the world was opened
        self._watchdog = DivergenceWatchdog(self)
        self.schedule.add(self._watchdog)
        self.engine = make_engine(self.physics)
        self.revisions = Revisions(self)

    def close(self) -> None:
        """Free the engine and other resources outside Python."""
        self.resources.close()
        self.engine.close()

    @_reporting
    def run(self, steps: int) -> int:
        """Advance by exactly `steps`: in each, time first, then hooks, then physics.

        Where time ends, the world is paused, which is reported as an error.

        Returns:
            the number of steps made: fewer if time ended.
        """
        clock, schedule, engine = self.clock, self.schedule, self.engine
        begin, last = clock.steps, clock.last_step()
        end = min(begin + steps, last)
        schedule.publish_ahead(end)
        while clock.steps < end:
            clock.steps += 1
            clock.steps += schedule.run(clock.steps, end, engine.step) - 1
        if begin + steps > last:
            self.paused = True
            what = f'the simulation is paused at {END} s: stamps of 32 bits end there. '
            what += 'reset_simulation begins again at 0 s'
            self.faults.report(what, logging.ERROR)
        return end - begin

    def set_physics(self, physics: PhysicsSettings) -> None:
        """Use these settings from the next step on."""
        self.physics = physics
        step_ns = self.clock.step_ns
        self.clock.set_step_size(physics.step_size)
        if self.clock.step_ns != step_ns:
            ratio = Fraction(self.clock.step_ns, step_ns)
            self.schedule.change_step(self.clock.steps, ratio)
            self._watchdog.check_soon()
        self.engine.apply(physics)

    def hold_physics(self, holder: object) -> None:
        """Disable physics, while time goes on, until each holder has released it."""
        self._holders.add(holder)
        self.engine.enable(False)

    def release_physics(self, holder: object) -> None:
        """Enable physics again, unless there is another holder."""
        self._holders.discard(holder)
        self.engine.enable(not self._holders)

    @_reporting
    def compile(self, spec: ModelSpec) -> CompiledModel:
        """Compile a model for spawning; the only method that any thread may call.

        Raises:
            ModelError: the engine cannot simulate it; the message says why.
        """
        return self.engine.compile(spec)

    @_reporting
    def spawn(self, model: ModelSpec | CompiledModel, name: str, pose: Pose) -> Model:
        """Spawn a model and load its plugins.

        A plugin that fails is reported and left out.

        Args:
            model: a `ModelSpec` is compiled first, which may take long.
            pose: of its frame.
        Raises:
            ModelError: the name is taken or empty, the pose is out of range, or as `compile`.
        """
        if not name:
            raise ModelError('a model needs a name; the one given is empty')
        if not all(abs(x) < MAX_COORDINATE for x in pose.position):
            raise ModelError(
                f"model '{name}' is to appear {max(pose.position, key=abs):g} m away; "
                f'less than {MAX_COORDINATE:g} m are accepted'
            )
        if name in self.models:
            raise ModelError(f"a model named '{name}' is in the world already")
        compiled = self.compile(model) if isinstance(model, ModelSpec) else model
        spawned = self.models[name] = Model(name, compiled, self.engine, pose)
        try:
            PartLoader(self, spawned).load()
        except BaseException:
            self._remove(spawned)  # before listeners hear of it
            raise
        for listener in self.listeners:
            listener.model_spawned(spawned)
        return spawned

    def overlaps(self, model: Model) -> dict[str, float]:
        """Return the models that overlap a model: name -> penetration depth [m]."""
        depths = {
            name: self.engine.overlap(model.body, other.body)
            for name, other in self.models.items()
            if other is not model
        }
        return {name: depth for name, depth in depths.items() if depth > 0.0}

    def touching(self, model: Model) -> list[str]:
        """Return the names of the models that touched a model in the last step."""
        bodies = self.engine.touching(model.body)
        return [name for name, other in self.models.items() if other.body in bodies]

    @_reporting
    def delete(self, name: str) -> None:
        """Delete a model and its plugins.

        Raises:
            NotFoundError: there is no such model.
        """
        model = self.models.get(name)
        if model is None:
            raise NotFoundError(f"there is no model named '{name}'")
        for listener in self.listeners:
            listener.model_deleted(model)
        diverged = model.has_diverged()
        self._remove(model)
        if diverged:
            # Otherwise non-finite numbers would remain in the engine and in bodies it touched.
            self.rebuild([other for other in self.models.values() if other.has_diverged()])

    def _remove(self, model: Model) -> None:
        self.external_forces.cancel(lambda target: target.model is model)
        self.holds.release(model)
        for part in reversed(model.parts):
            self.schedule.remove(part)
            part.unload()
        model.remove_from_engine()
        del self.models[model.name]
        self.revisions.forget()

    @_reporting
    def reset_world(self) -> None:
        """Bring every model back to its spawn pose, at rest; joints stay, time goes on."""
        for model in self.models.values():
            model.set_pose(model.initial_pose)
            if not model.static:
                model.set_twist(Twist())
        for part in self._parts():
            part.reset()
        self._notify_reset()

    @_reporting
    def reset_simulation(self) -> None:
        """Restart at time zero: every model at its spawn pose, with the same motion as then.

        Properties that were set meanwhile, such as masses and joint limits, stay.
        """
        self.clock.reset()
        self._watchdog.check_soon()
        self.external_forces.cancel(lambda target: True)
        self.holds.clear()
        self.engine.reset()
        for model in self.models.values():
            model.add_to_engine()
        for part in self._parts():
            part.restart()
        self._notify_reset()

    def save_state(self) -> SavedState:
        """Return the state of the world at this moment, for `restore`.

        From here on the world moves bit for bit as after each `restore` of this state. Saving makes
        the engine recompute all contacts, which moves bodies by less than 1 um/step.
        """
        own = self.external_forces, self.holds, self._watchdog
        return SavedState(self, (*own, *self._parts()))

    @_reporting
    def restore(self, state: SavedState) -> None:
        """Restore a saved state, including time and the state of plugins.

        Readers of outputs and listeners are not changed.

        Raises:
            SimError: the state is of another world, or models were spawned, deleted or changed
                since.
        """
        state.restore(self)
        self._notify_reset()

    def rebuild(self, diverged: list[Model]) -> None:
        """Rebuild the engine; `diverged` models restart at their spawn pose, others continue."""
        self.rebuilds += 1
        motions = {
            model.name: self.engine.motion(model.body)
            for model in self.models.values()
            if model not in diverged
        }
        self.engine.reset()
        for model in self.models.values():
            model.add_to_engine()
            if model.name in motions:
                self.engine.set_motion(model.body, motions[model.name])
        for model in diverged:
            for part in model.parts:
                part.restart()
            what = (
                f"model '{model.name}' diverged: its pose or velocity was no longer a number of "
                'this world. It is back where it was spawned; a command, force or property was '
                'too large'
            )
            self.faults.report(what, logging.ERROR, model=model.name)

    def find_entity(self, name: str) -> Entity | None:
        """Return the first entity with that scoped or plain name, depth first in world order."""
        for model in self.models.values():
            if name == model.name:
                return model
            for link in model.links.values():
                if name in link.names:
                    return link
                for collision in link.collisions.values():
                    if name in collision.names:
                        return collision
            for inner in nested_models(model) if model.spec.nested else ():
                if name in inner.names:
                    return inner
        return None

    def find_model(self, name: str) -> Model | NestedModel | None:
        """Return the first entity of that name if it is a model, else None."""
        entity = self.find_entity(name)
        return entity if isinstance(entity, Model | NestedModel) else None

    def find_joint(self, name: str) -> Joint | None:
        """Return the joint with that plain or scoped name in the first model that has it."""
        for model in self.models.values():
            with contextlib.suppress(NotFoundError):
                return model.joint(name)
        return None

    def frame(self, name: str) -> tuple[Pose, Twist]:
        """Return pose and twist of a reference frame: an entity, or the world by its names.

        Raises:
            NotFoundError: nothing in the world has that name.
        """
        entity = self.find_entity(name)
        if entity is not None:
            return entity.state()
        if name in WORLD_FRAMES:
            return IDENTITY, Twist()
        raise NotFoundError(f"there is no model, link or collision named '{name}'")

    def _parts(self) -> Iterator[ModelPart]:
        for model in self.models.values():
            yield from model.parts

    def _notify_reset(self) -> None:
        for listener in self.listeners:
            listener.world_reset()
