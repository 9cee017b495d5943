"""The interface of a world to a plugin of a model."""

from collections.abc import Iterable

from ..description import PluginSpec
from .model_part import ModelPart


class Plugin(ModelPart):
    """A plugin loaded by a <plugin> element."""

    spec: PluginSpec

    def __repr__(self) -> str:
        """Return its kind and name."""
        return f'<{type(self).__name__} {self.spec.name}>'

    def shared(self) -> Iterable[object]:
        """Return the description."""
        return (self.spec,)
