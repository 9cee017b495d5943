"""The controls of time on the page of a world: they hold up whoever runs it."""

import threading
from collections.abc import Callable
from dataclasses import replace

from ..sim import SimError, World
from .commands import WorldCommands


class Pace:
    """Pause, steps and speed; a program resets its world itself."""

    def __init__(self) -> None:
        self.changed = threading.Condition()
        self.paused = False
        self.steps = 0  # to make while paused
        self.factor = 1.0  # of real time; 0: as fast as possible

    def pause(self) -> None:
        """Hold the program in its step."""
        with self.changed:
            self.paused = True

    def unpause(self) -> None:
        """Let it go on."""
        with self.changed:
            self.paused = False
            self.changed.notify_all()

    def step(self, steps: int) -> None:
        """Let it make so many steps of physics, and hold it again."""
        with self.changed:
            self.paused, self.steps = True, self.steps + steps
            self.changed.notify_all()

    def reset_world(self) -> None:
        """Refuse: the program resets.

        Raises:
            SimError: always.
        """
        raise SimError('the program that runs this world resets it')

    def reset_simulation(self) -> None:
        """Refuse, as `reset_world`."""
        self.reset_world()

    def set_speed(self, factor: float) -> None:
        """Set the target real-time factor; 0: as fast as possible."""
        with self.changed:
            self.factor = factor
            self.changed.notify_all()

    def allowed(
        self, steps: int, timeout: float, is_disturbed: Callable[[], bool] = lambda: False
    ) -> int:
        """Return how many of so many steps may be made now; wait for the first for a while.

        Args:
            steps: that are to be made.
            timeout: [s, wall].
            is_disturbed: ends the waiting; asked when `changed` is notified.
        """
        with self.changed:
            self.changed.wait_for(lambda: self.steps or not self.paused or is_disturbed(), timeout)
            if not self.paused:
                self.steps = 0
                return steps
            steps = min(steps, self.steps)
            self.steps -= steps
            return steps


class WorldPace(Pace):
    """The time of a world that the page may reset, too."""

    def __init__(self, world: World) -> None:
        super().__init__()
        self._world = world
        self.commands = WorldCommands(self.changed)
        self.factor = world.physics.max_update_rate * world.physics.step_size

    def reset_world(self) -> None:
        """Return every model to its spawn pose; time is kept."""
        self.commands.call(self._world.reset_world)

    def reset_simulation(self) -> None:
        """Restart at time zero."""
        self.commands.call(self._world.reset_simulation)

    def set_speed(self, factor: float) -> None:
        """Set the target real-time factor, also in the world; 0: as fast as possible."""
        super().set_speed(factor)
        world = self._world
        self.commands.post(
            lambda: world.set_physics(
                replace(world.physics, max_update_rate=factor / world.physics.step_size)
            )
        )
