"""A nested model: it has a name and a frame of its own; its parts belong to the outer model."""

from dataclasses import replace
from typing import TypeVar

from ..core import Pose, Twist, compose, inverse, relative
from ..description import ModelSpec
from .model import Joint, Link, Model

_LEVEL = '::'


class NestedModel:
    """A view of the outer model with the interface of `Model`.

    Its frame moves with its first link.
    """

    def __init__(self, outer: Model, path: str) -> None:
        """Use the nested model called `path` in `outer`, e.g. 'arm' or 'arm::hand'."""
        prefix = path + _LEVEL
        parent, _, own_name = path.rpartition(_LEVEL)
        self.outer = outer
        self.name = self.scoped_name = f'{outer.name}{_LEVEL}{path}'
        self.names = {self.scoped_name, path, own_name}
        self.parent_name = parent.rpartition(_LEVEL)[2] or outer.name
        self.static = outer.static
        self.links: dict[str, Link] = _within(prefix, outer.links)
        self.joints: dict[str, Joint] = _within(prefix, outer.joints)
        self.spec = ModelSpec(
            path,
            tuple(replace(link.spec, name=name) for name, link in self.links.items()),
            tuple(
                replace(joint, name=joint.name.removeprefix(prefix))
                for joint in outer.spec.joints
                if joint.name.startswith(prefix)
            ),
            static=outer.static,
            nested={
                name.removeprefix(prefix): pose
                for name, pose in outer.spec.nested.items()
                if name.startswith(prefix)
            },
        )
        self._first = next(iter(self.links.values()))
        self._in_first = relative(outer.spec.nested[path], self._first.spec.pose)

    def state(self) -> tuple[Pose, Twist]:
        """Return the pose of the model's frame and the twist of its first link, in the world."""
        pose, twist = self._first.state()
        return compose(pose, self._in_first), twist

    def set_pose(self, pose: Pose) -> None:
        """Move the first link so that the model's frame comes to `pose`; see `Model.move_link`."""
        first = compose(pose, inverse(self._in_first))
        self.outer.move_link(self._first, first, self._first.twist)

    def set_twist(self, twist: Twist) -> None:
        """Let the first link move with this velocity, in world axes; see `Model.move_link`."""
        self.outer.move_link(self._first, self._first.pose, twist)


Part = TypeVar('Part')


def _within(prefix: str, parts: dict[str, Part]) -> dict[str, Part]:
    return {
        name.removeprefix(prefix): part for name, part in parts.items() if name.startswith(prefix)
    }


def nested_models(outer: Model) -> list[NestedModel]:
    """Return the nested models with links, in the order of the description."""
    return [
        NestedModel(outer, path)
        for path in outer.spec.nested
        if any(name.startswith(path + _LEVEL) for name in outer.links)
    ]
