"""What a window is shown of a world: everything at first, then what has changed."""

from itertools import count

from ..core import Pose
from ..description import (
    ModelSpec,
    SceneChange,
    ShownLink,
    ShownModel,
    ShownMotion,
    ShownSensor,
)
from .model import Link, Model
from .world import World


class ShownWorld:
    """What was shown of a world, to find what has changed."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._numbers = count()
        self._models: dict[str, tuple[Model, ModelSpec]] = {}
        self._links: dict[int, tuple[Link, Pose]] = {}  # with the pose as last shown
        self._settings: object = None
        self.reset()

    def reset(self) -> None:
        """Show everything next time."""
        self._models.clear()
        self._links.clear()
        self._settings = None

    def change(self) -> SceneChange | None:
        """Return what has changed since the last call; None for nothing."""
        world = self._world
        found = {name: (model, model.spec) for name, model in world.models.items()}
        settings = (dict(world.lights), world.scene, world.physics)
        if (found, settings) == (self._models, self._settings):
            return None
        reset = self._settings is None
        removed = tuple(name for name, seen in self._models.items() if found.get(name) != seen)
        gone = {self._models[name][0] for name in removed}
        self._links = {
            number: shown for number, shown in self._links.items() if shown[0].model not in gone
        }
        added = tuple(
            self._shown(name, model)
            for name, (model, _) in found.items()
            if self._models.get(name) != found[name]
        )
        self._models, self._settings = found, settings
        return SceneChange(
            reset,
            added,
            removed,
            dict(world.lights),
            world.scene,
            world.physics.step_size,
            world.physics.max_update_rate,
            world.name,
        )

    def motion(self, real_time: float) -> ShownMotion:
        """Return the clock, and the links that moved since they were last shown."""
        moved = {}
        for number, (link, shown) in self._links.items():
            pose = link.pose
            if pose != shown:
                moved[number] = pose
                self._links[number] = link, pose
        clock = self._world.clock
        return ShownMotion(clock.now, real_time, clock.steps, self._world.paused, moved)

    def _shown(self, name: str, model: Model) -> ShownModel:
        links = []
        for link in model.links.values():
            spec = link.spec
            sensors = (ShownSensor(one.name, one.type, one.pose) for one in spec.sensors)
            shown = ShownLink(
                next(self._numbers),
                link.name,
                link.pose,
                spec.visuals,
                spec.collisions,
                spec.inertial,
                spec.gravity,
                tuple(sensors),
            )
            self._links[shown.number] = link, shown.pose
            links.append(shown)
        joints = tuple(joint.spec for joint in model.joints.values())
        return ShownModel(name, tuple(links), joints, model.static, model.spec.links[0].pose)
