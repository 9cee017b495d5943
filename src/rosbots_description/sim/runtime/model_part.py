"""What a world asks of the plugins and sensors of its models."""

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
        """Return what it holds that is no part of its state, beside the world's parts.

        Such are its description, outputs, since their readers come from outside, and what never
        changes. All else that its attributes lead to is copied when the state of the world is
        saved.
        """
        return ()

    def unload(self) -> None:
        """Let go of what it holds; the model is about to be deleted."""
