"""The interface of a world to a plugin of a model."""

from collections.abc import Iterable, Mapping
from typing import Any

from ..description import PluginSpec
from .model_part import ModelPart


class Plugin(ModelPart):
    """A plugin loaded by a <plugin> element."""

    spec: PluginSpec

    def __repr__(self) -> str:
        """Return its kind and name."""
        return f'<{type(self).__name__} {self.spec.name}>'

    @property
    def controllers(self) -> Mapping[str, Any]:
        """Return the loaded controllers by name, if it is one that gives a robot controllers."""
        return {}

    def shared(self) -> Iterable[object]:
        """Return the description."""
        return (self.spec,)
