"""The contacts of a world, while a browser shows them."""

from collections.abc import Callable, Sequence

from ..sim import World
from ..sim.description import ShownContact


class WorldContacts:
    """Computes the contacts each time that the world is shown, and only if they are."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._callback: Callable[[Sequence[ShownContact]], None] | None = None

    def open(self, show: Callable[[Sequence[ShownContact]], None]) -> None:
        """Begin to call back, on the thread that owns the world."""
        self._callback = show

    def close(self) -> None:
        """End that."""
        self._callback = None

    def show(self) -> None:
        """Call back with the contacts of the last step."""
        show = self._callback
        if show is not None:
            show(
                [
                    ShownContact(one.position, one.normal, one.force)
                    for one in self._world.engine.contacts()
                ]
            )
