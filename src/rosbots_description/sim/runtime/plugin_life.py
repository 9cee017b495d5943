"""What a world asks of the plugins of its models."""

from ..description import PluginSpec
from .scheduler import Hook


class Plugin(Hook):
    """Something that lives with a model and runs in the steps it asks for."""

    spec: PluginSpec

    def start(self) -> None:
        """Load and begin.

        Raises:
            PluginError: it cannot work; the model then lives on without it.
        """
        raise NotImplementedError

    def reset(self) -> None:
        """Go on where the world stands now; all models are back at their spawn poses."""

    def restart(self) -> None:
        """Begin as after `start`: time may be zero again, and all joints are new."""
        self.reset()

    def unload(self) -> None:
        """Let go of what the plugin holds; the model is about to be deleted."""
