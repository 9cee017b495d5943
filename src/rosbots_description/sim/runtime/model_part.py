"""The interface of a world to the plugins and sensors of its models."""

from collections.abc import Iterable

from .scheduler import Hook


class ModelPart(Hook):
    """A hook that belongs to a model and runs in the steps that it requests."""

    def start(self) -> None:
        """Load and begin.

        Raises:
            PluginError: it cannot be loaded; the model is spawned without it.
        """
        raise NotImplementedError

    def reset(self) -> None:
        """Continue after a world reset; all models are back at their spawn poses."""

    def restart(self) -> None:
        """Start again as after `start`: time may be zero again, and all joints are new."""
        self.reset()

    def count_readers(self) -> None:
        """Determine which outputs have readers; they may have changed."""

    def shared(self) -> Iterable[object]:
        """Return referenced objects that are not part of its state, besides those of the world.

        Examples are its description, its outputs (their readers are external) and constants. All
        other objects reachable from its attributes are copied when the world's state is saved.
        """
        return ()

    def components(self) -> Iterable[object]:
        """Return objects of its state that others refer to, such as the controllers of a robot.

        They keep their identity: when the world's state is restored, so are their attributes.
        """
        return ()

    def unload(self) -> None:
        """Release resources; the model is about to be deleted."""
