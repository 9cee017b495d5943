"""The interface of a world to a plugin of a model."""

from collections.abc import Iterable, Mapping
from typing import Any

from ..description import PluginSpec
from ..plugin_registry import library_name
from .model_part import ModelPart


class Plugin(ModelPart):
    """A plugin loaded by a <plugin> element."""

    spec: PluginSpec

    def __repr__(self) -> str:
        """Return its kind and name."""
        return f'<{type(self).__name__} {self.name}>'

    @property
    def name(self) -> str:
        """Return the name in its <plugin>; the file name of its library if there is none."""
        return self.spec.name or library_name(self.spec.filename)

    @property
    def controllers(self) -> Mapping[str, Any]:
        """Return the loaded controllers by name, if it is one that gives a robot controllers."""
        return {}

    def shared(self) -> Iterable[object]:
        """Return the description."""
        return (self.spec,)
