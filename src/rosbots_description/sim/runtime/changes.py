"""What has changed in a world: a reader keeps the last revision that it saw, and asks what is new.

Nothing is looked at without a reader, and once for however many: models only after something was
added, removed or placed, links only when they may have moved.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple
from weakref import proxy

from ..core import Pose
from ..description import ModelSpec, PhysicsSettings

if TYPE_CHECKING:
    from .model import Link, Model
    from .world import World

Models = dict['Model', ModelSpec]


class Revision(NamedTuple):
    """A world as its readers see it at one time; shared by them, and never changed."""

    models: Models
    poses: dict[Link, Pose]  # in the world
    scenery: object  # lights and scene
    physics: PhysicsSettings | None


NOTHING = Revision({}, {}, None, None)  # what a reader has seen at first


class Changes(NamedTuple):
    """What is new in a revision.

    Attributes:
        revision: to ask with next time.
        added: models, in the order of the world.
        respecified: models that have the same parts, described anew.
        removed: names of models, each of which may be among those added.
        scenery: whether lights or scene differ.
        physics: whether settings of physics differ.
        moved: poses of links in the world; those of added models are among them.
    """

    revision: Revision
    added: list[Model]
    respecified: list[Model]
    removed: list[str]
    scenery: bool
    physics: bool
    moved: dict[Link, Pose]

    @property
    def appearance(self) -> bool:
        """Whether what is seen differs by more than poses."""
        return bool(self.added or self.respecified or self.removed or self.scenery)


class Revisions:
    """The revisions of a world."""

    def __init__(self, world: World) -> None:
        self._world = proxy(world)  # a world may keep its readers, which keep this
        self._engine = world.engine
        self.forget()

    def forget(self) -> None:
        """Keep nothing of the world alive until the next look."""
        self._models, self._poses = NOTHING.models, NOTHING.poses
        # The engine's counters, when models were looked at, and when poses were read.
        self._placements, self._read = -1, (-1, -1)

    def models(self) -> Models:
        """Return the models; the same object until one is added, respecified or removed."""
        if self._placements != self._engine.placements:
            self._placements = self._engine.placements
            found = {model: model.spec for model in self._world.models.values()}
            if found != self._models:
                self._models = found
        return self._models

    def since(self, before: Revision) -> Changes:
        """Return what is new since a revision."""
        models, poses, old = self.models(), self._look_at_links(), before.models
        scenery, physics = (dict(self._world.lights), self._world.scene), self._world.physics
        return Changes(
            Revision(models, poses, scenery, physics),
            [model for model in models if model not in old],
            [model for model, spec in models.items() if old.get(model, spec) is not spec],
            [model.name for model in old if model not in models],
            scenery != before.scenery,
            physics != before.physics,
            {}
            if poses is before.poses
            else {link: pose for link, pose in poses.items() if before.poses.get(link) != pose},
        )

    def _look_at_links(self) -> dict[Link, Pose]:
        last, self._read = self._read, (self._engine.placements, self._engine.advances)
        if last[0] != self._read[0]:
            links = (link for model in self._models for link in model.links.values())
            self._poses = {link: link.pose for link in links}
        elif last != self._read:
            moving = (link for link in self._poses if not link.model.static)
            self._poses = self._poses | {link: link.pose for link in moving}
        return self._poses
