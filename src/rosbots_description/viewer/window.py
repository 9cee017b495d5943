"""A page on which a program shows the world that it runs."""

import math
import threading
import time
from collections.abc import Sequence

from .. import web
from ..sim import Fault, SimError, World
from ..web import Page, Site, WindowError
from .pace import Pace
from .scene import ReleasingView, WorldView

FRAME = 1.0 / 30.0  # [s, simulated and wall] between two motions that are shown
_POLL = 0.5  # [s, wall] between two refreshes of the page


class Window:
    """Serves the page at `address` on this machine; it is what the page knows as its simulator.

    The program gives the commands, so the page only shows, pauses and paces.
    """

    robots: web.Robots | None = None
    joints: web.Joints | None = None
    sensors: web.ShownTopics | None = None
    maps: web.Maps | None = None
    goals: web.Goals | None = None
    signals: web.Signals | None = None
    inspection: web.Inspection | None = None
    contacts: web.Contacts | None = None
    editor: web.Editor | None = None
    library: web.Library | None = None
    worlds: web.Worlds | None = None

    def __init__(self, world: World, port: int) -> None:
        """Begin to serve.

        Args:
            port: 0 for any that is free.
        Raises:
            SimError: the port is in use.
        """
        self.time: Pace = Pace()
        self._serve(world, ReleasingView(world, self.time), open_site(port))

    def _serve(self, world: World, view: WorldView, site: Site) -> None:
        self._world, self.view, self.site = world, view, site
        self._due = 0.0  # [s, monotonic] when the next motion is shown
        self.address = site.address
        self._page = Page(site, self)
        self._ended = threading.Event()
        threading.Thread(target=self._poll, name='page', daemon=True).start()

    def faults(self) -> Sequence[Fault]:
        """Return the faults of the world, for the page."""
        return self._world.faults[:]

    def run(self, steps: int) -> int:
        """Make steps of the world, at the pace of the page while a browser is connected.

        Returns:
            the number of steps made: fewer if time ended.
        """
        made, frame = 0, self._frame
        while made < steps:
            self._begin_frame()
            if not self.view.is_open:
                return made + self._advance(steps - made)
            allowed = self.time.allowed(min(steps - made, frame), FRAME)
            advanced = self._advance(allowed)
            made += advanced
            if advanced < allowed:
                break
            self._wait(advanced * self._world.physics.step_size)
            self._show()
        return made

    def show(self, world: World) -> None:
        """Show a world from now on, as it is now."""
        if world is not self._world:
            self._world = world
            self.view.follow(world)
        self._show()

    def close(self) -> None:
        """Stop serving."""
        if not self._ended.is_set():
            self._ended.set()
            self.site.stop()

    @property
    def _frame(self) -> int:
        """Return the steps between two motions that are shown."""
        return max(1, math.floor(FRAME / self._world.physics.step_size))

    def _advance(self, steps: int) -> int:
        return self._world.run(steps)

    def _begin_frame(self) -> None:
        """Do what is due between two frames."""

    def _show(self) -> None:
        self.view.show()

    def _wait(self, seconds: float) -> None:
        """Wait until the wall clock has advanced like simulated time."""
        factor, now = self.time.factor, time.monotonic()
        if factor > 0.0:
            self._due = max(self._due, now - FRAME) + seconds / factor
            time.sleep(max(0.0, min(self._due - now, 1.0)))

    def _poll(self) -> None:
        while not self._ended.wait(_POLL):
            self.view.repeat()
            self._page.poll()


def open_site(port: int, *, is_framed: bool = False) -> Site:
    """Return a site on this machine.

    Args:
        port: 0 for any that is free.
        is_framed: pages of this machine, such as notebooks, may show it in a frame.
    Raises:
        SimError: the port is in use.
    """
    try:
        return Site('127.0.0.1', port, is_framed=is_framed)
    except WindowError as error:
        raise SimError(str(error)) from None
