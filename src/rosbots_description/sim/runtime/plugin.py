"""What a world asks of a plugin of a model."""

from collections.abc import Iterable

from ..description import PluginSpec
from .model_part import ModelPart


class Plugin(ModelPart):
    """What a <plugin> loads."""

    spec: PluginSpec

    def shared(self) -> Iterable[object]:
        """Return the description."""
        return (self.spec,)
