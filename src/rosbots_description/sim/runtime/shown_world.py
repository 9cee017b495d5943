"""What a window is shown of a world: everything at first, then what has changed."""

from itertools import count

from ..description import SceneChange, ShownLink, ShownModel, ShownMotion, ShownSensor
from .changes import NOTHING
from .model import Link, Model
from .world import World


class ShownWorld:
    """A reader of a world's changes; numbers what it shows."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._numbers = count()
        self._links: dict[str, dict[Link, int]] = {}  # numbers, by models
        self.reset()

    def reset(self) -> None:
        """Show everything next time."""
        self._changed = self._moved = NOTHING

    def change(self) -> SceneChange | None:
        """Return what has changed since the last call; None for nothing."""
        world = self._world
        is_first = self._changed is NOTHING
        changes = world.revisions.since(self._changed)
        self._changed = changes.revision
        if not (changes.appearance or changes.physics):
            return None
        if is_first:
            self._links.clear()
            self._moved = changes.revision
        gone = [*changes.removed, *(model.name for model in changes.respecified)]
        removed = tuple(name for name in gone if self._links.pop(name, None) is not None)
        added = {*changes.added, *changes.respecified}
        return SceneChange(
            is_first,
            tuple(self._shown(model) for model in world.models.values() if model in added),
            removed,
            dict(world.lights),
            world.scene,
            world.physics.step_size,
            world.physics.max_update_rate,
            world.name,
        )

    def motion(self, real_time: float) -> ShownMotion:
        """Return the clock, and the links that moved since they were last shown."""
        changes = self._world.revisions.since(self._moved)
        self._moved = changes.revision
        moved = {}
        for link, pose in changes.moved.items():
            number = self._links.get(link.model.name, {}).get(link)
            if number is not None:
                moved[number] = pose
        clock = self._world.clock
        return ShownMotion(clock.now, real_time, clock.steps, self._world.paused, moved)

    def _shown(self, model: Model) -> ShownModel:
        links = []
        for link in model.links.values():
            spec = link.spec
            sensors = (ShownSensor(one.name, one.type, one.pose) for one in spec.sensors)
            shown = ShownLink(
                next(self._numbers),
                link.name,
                self._changed.poses[link],
                spec.visuals,
                spec.collisions,
                spec.inertial,
                spec.gravity,
                tuple(sensors),
            )
            links.append(shown)
        numbers = (link.number for link in links)
        self._links[model.name] = dict(zip(model.links.values(), numbers, strict=True))
        joints = tuple(joint.spec for joint in model.joints.values())
        return ShownModel(model.name, tuple(links), joints, model.static, model.spec.links[0].pose)
