"""A world of an environment in the browser, on the page of `web`, without ROS."""

import math
import threading
import time
from collections.abc import Callable

from ..sim import SimError, World
from ..sim.description import SceneChange, ShownMotion
from ..sim.runtime import ShownWorld
from ..web import Page, Site, WindowError

_FRAME = 1.0 / 30.0  # [s, simulated and wall] between two motions that are shown
_POLL = 0.5  # [s, wall] between two looks of the page


class EnvTime:
    """The clock's controls: they hold up the steps of the environment, in its own thread."""

    def __init__(self) -> None:
        self.changed = threading.Condition()
        self.paused = False
        self.steps = 0  # to make while paused
        self.factor = 1.0  # of real time; 0: as fast as possible

    def pause(self) -> None:
        """Hold the environment in its step."""
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
        raise SimError('the program that made this environment resets it')

    reset_simulation = reset_world

    def set_speed(self, factor: float) -> None:
        """Set the target real-time factor; 0: as fast as possible."""
        with self.changed:
            self.factor = factor
            self.changed.notify_all()

    def allowed(self, steps: int, timeout: float) -> int:
        """Return how many of so many steps may be made now; wait for the first for a while.

        Args:
            steps: that are to be made.
            timeout: [s, wall].
        """
        with self.changed:
            self.changed.wait_for(lambda: self.steps or not self.paused, timeout)
            if not self.paused:
                self.steps = 0
                return steps
            steps = min(steps, self.steps)
            self.steps -= steps
            return steps


class EnvView:
    """The scene of an environment's world, for those who look; written by its own thread."""

    def __init__(self, world: World, clock: EnvTime) -> None:
        self._world, self._clock = world, clock
        self._shown = ShownWorld(world)
        self._lock = threading.Lock()
        self._change: Callable[[SceneChange], None] | None = None
        self._motion: Callable[[ShownMotion], None] | None = None
        self._is_new = False
        self._begun = time.monotonic()

    @property
    def is_open(self) -> bool:
        """Return whether somebody looks."""
        return self._change is not None

    def open(self, change: Callable[[SceneChange], None],
             motion: Callable[[ShownMotion], None]) -> None:
        """Begin to call back, when the environment makes a step."""
        with self._lock:
            self._change, self._motion, self._is_new = change, motion, True

    def close(self) -> None:
        """End that, and let the environment go on."""
        with self._lock:
            self._change = self._motion = None
        self._clock.unpause()

    def follow(self, world: World) -> None:
        """Show another world from now on."""
        self._world, self._shown = world, ShownWorld(world)

    def show(self) -> None:
        """Call back what has changed."""
        with self._lock:
            change, motion, is_new, self._is_new = self._change, self._motion, self._is_new, False
        if change is None or motion is None:
            return
        if is_new:
            self._shown.reset()
        changed = self._shown.change()
        if changed is not None:
            change(changed)
        self._world.paused = self._clock.paused
        motion(self._shown.motion(time.monotonic() - self._begun))


class Window:
    """Serves the page at `address` on this machine; it is what the page knows as its simulator."""

    # Actions come from the program.
    robots = joints = sensors = maps = goals = signals = None
    inspection = contacts = hands = library = worlds = None

    def __init__(self, world: World, port: int) -> None:
        """Begin to serve.

        Args:
            world: of the environment.
            port: 0 for any that is free.
        Raises:
            SimError: the port is in use.
        """
        self._world = world
        self._due = 0.0  # [s, monotonic] when the next motion is shown
        self.time = EnvTime()
        self.view = EnvView(world, self.time)
        try:
            self._site = Site('127.0.0.1', port)
        except WindowError as error:
            raise SimError(str(error)) from None
        self.address = self._site.address
        self._page = Page(self._site, self)
        self._ended = threading.Event()
        threading.Thread(target=self._poll, name='page', daemon=True).start()

    def run(self, steps: int) -> None:
        """Make steps of the world; as fast as possible, unless somebody looks."""
        frame = max(1, math.floor(_FRAME / self._world.physics.step_size))
        while steps > 0:
            if not self.view.is_open:
                self._world.run(steps)
                return
            now = self.time.allowed(min(steps, frame), _FRAME)
            self._world.run(now)
            steps -= now
            self._wait(now * self._world.physics.step_size)
            self.view.show()

    def show(self, world: World) -> None:
        """Show a world from now on, as it is now."""
        if world is not self._world:
            self._world = world
            self.view.follow(world)
        self.view.show()

    def close(self) -> None:
        """End to serve."""
        self._ended.set()
        self._site.stop()

    def _wait(self, seconds: float) -> None:
        """Wait until the wall clock has advanced like simulated time."""
        factor, now = self.time.factor, time.monotonic()
        if factor > 0.0:
            self._due = max(self._due, now - _FRAME) + seconds / factor
            time.sleep(max(0.0, min(self._due - now, 1.0)))

    def _poll(self) -> None:
        while not self._ended.wait(_POLL):
            self._page.poll()
