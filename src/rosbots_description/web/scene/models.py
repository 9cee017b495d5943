"""The models of the page: what there is, and where it is now."""

from collections.abc import Mapping

from ...sim.core import Pose, compose, inverse
from ...sim.description import SceneChange, ShownLink, ShownModel, ShownMotion
from ..controls import Panel


class Models(Panel):
    """Keeps what the simulator has shown; the first of all panels, so that others can ask it."""

    def __init__(self) -> None:
        self._models: dict[str, ShownModel] = {}
        self._poses: dict[int, Pose] = {}  # of links in the world, by their numbers

    @property
    def all(self) -> Mapping[str, ShownModel]:
        """Return all models by name, in the order in which they came."""
        return self._models

    def link_pose(self, link: ShownLink) -> Pose:
        """Return the pose of a link's frame in the world."""
        return self._poses.get(link.number, link.pose)

    def pose(self, model: str, link: str | None = None) -> Pose:
        """Return the pose of a model's frame in the world, or of that of one of its links.

        Raises:
            KeyError: there is no such model.
        """
        shown = self._models[model]
        for one in shown.links:
            if one.name == link:
                return self.link_pose(one)
        return compose(self.link_pose(shown.links[0]), inverse(shown.canonical_pose))

    def links_for(self, topic: str) -> dict[str, ShownLink]:
        """Return links by name, and by model and name; one name has that of the topic's robot."""
        spaces = topic.split('/')
        found: dict[str, ShownLink] = {}
        for model in sorted(self._models.values(), key=lambda model: model.name not in spaces):
            for link in model.links:
                found[f'{model.name}/{link.name}'] = link
                found.setdefault(link.name, link)
        return found

    def apply(self, change: SceneChange) -> None:
        """Take in models that came, changed or went."""
        models = dict(self._models)  # others may be iterating over the old ones
        if change.reset:  # its numbers may be those of another simulator
            models.clear()
            self._poses.clear()
        for name in change.removed:
            if shown := models.pop(name, None):
                for link in shown.links:
                    self._poses.pop(link.number, None)
        self._models = models | {model.name: model for model in change.models}

    def move(self, motion: ShownMotion) -> None:
        """Take in poses."""
        self._poses |= motion.poses
