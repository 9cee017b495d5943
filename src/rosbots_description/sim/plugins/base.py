"""What every model plugin is: a hook with parameters and a life."""

from typing import TYPE_CHECKING

from ..schedule import Hook
from ..spec import PluginSpec

if TYPE_CHECKING:
    from ..model import Model
    from ..world import World


class ModelPlugin(Hook):
    """Code that lives with a model: load, update at the steps it asks for, reset, unload.

    A subclass reads its tags in `load` and raises `PluginError` when it cannot work; the model
    then lives on without it.
    """

    def __init__(self, world: 'World', model: 'Model', spec: PluginSpec) -> None:
        self.world = world
        self.model = model
        self.spec = spec

    def load(self) -> None:
        """Read the parameters and find what the plugin works on."""

    def reset(self) -> None:
        """Begin anew where the world stands now; all models are back at their spawn poses."""

    def restart(self) -> None:
        """Be as right after `load`; time is zero again and all joints are new."""
        self.reset()

    def unload(self) -> None:
        """Let go of what the plugin holds; the model is about to be deleted."""
