"""A page on which a world is seen and controlled; the world runs here."""

from collections.abc import Callable

from ..sim import World
from ..sim.physics import CrashSandbox
from ..sim.runtime import World as RunningWorld
from ..web import Site
from .contacts import WorldContacts
from .editor import WorldEditor
from .inspection import WorldInspection
from .joints import WorldJoints
from .pace import WorldPace
from .robots import WorldRobots
from .scene import RelayedView
from .sensors import WorldSensors
from .window import FRAME, Window
from .worlds import WorldFiles, WorldLibrary


class Viewer(Window):
    """Serves the page of a world; `run` and `serve` are for the thread that owns the world."""

    def __init__(
        self,
        world: World,
        site: Site,
        *,
        paused: bool = False,
        sandbox: CrashSandbox | None = None,
    ) -> None:
        """Begin to serve; the page shows the world from the first `run` or `serve` on.

        Args:
            sandbox: tests what the page inserts; None: it is not tested.
        """
        self.time = pace = WorldPace(world)
        pace.paused = paused
        self.commands = commands = pace.commands
        self.robots = WorldRobots(world, commands)
        self.joints = WorldJoints(world, commands)
        self.inspection = WorldInspection(world, commands)
        self.editor = WorldEditor(world, commands, sandbox)
        self.sensors = WorldSensors(world, commands)
        self.contacts = self._contacts = WorldContacts(world)
        self.worlds = WorldFiles(world, commands)
        self.library = WorldLibrary(world)
        self._serve(world, RelayedView(world, self.time), site)

    def __repr__(self) -> str:
        """Return its kind and the address."""
        return f'<{type(self).__name__} at {self.address}>'

    def close(self) -> None:
        """Stop serving; a command that waits is refused."""
        self.commands.end()
        super().close()

    def serve(self, is_over: Callable[[], bool] = lambda: False) -> None:
        """Run the world as the page says, until `is_over`; called about 30 times a second."""
        while not is_over():
            self.turn()

    def serve_until_interrupted(self) -> None:
        """Run the world as the page says, until Ctrl-C; then stop serving."""
        try:
            self.serve()
        except KeyboardInterrupt:
            pass
        finally:
            self.close()

    def turn(self) -> None:
        """Carry out what the page commands, and let time go on for about 1/30 s."""
        self._world.is_paced = self.time.factor > 0.0
        try:
            self._run_some()
        finally:
            self._world.is_paced = False

    def _run_some(self) -> None:
        self._begin_frame()
        slow = min(self.time.factor or 1.0, 1.0)  # so that commands never wait for long
        allowed = self.time.allowed(
            max(1, int(slow * self._frame)), FRAME, lambda: self.commands.are_waiting
        )
        self._wait(self._advance(allowed) * self._world.physics.step_size)
        self._show()

    def _advance(self, steps: int) -> int:
        return RunningWorld.run(self._world, steps)  # not that of a world which runs by `run`

    def _begin_frame(self) -> None:
        self.commands.carry_out()

    def _show(self) -> None:
        super()._show()
        self._contacts.show()
