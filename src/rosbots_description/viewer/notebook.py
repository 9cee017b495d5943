"""A world on its page below the cell of a notebook, or beside a script."""

import html
import json
import sys
import threading
from collections.abc import Callable
from typing import Protocol

from ..sim import World
from .viewer import Viewer
from .window import open_site


class _Events(Protocol):
    """Those of a shell of IPython."""

    def register(self, event: str, function: Callable[..., object]) -> None:
        """Call a function at an event."""

    def unregister(self, event: str, function: Callable[..., object]) -> None:
        """Call it no more."""


class _Shell(Protocol):
    """What is used of a shell of IPython, which needs not be installed."""

    events: _Events


class ShownViewer(Viewer):
    """The page of a world that a script or a notebook owns.

    In a notebook the world belongs to the cell while one runs, and else to a thread that runs it
    as the page says.
    """

    def __init__(self, world: World, port: int, height: int) -> None:
        """Begin to serve; see `World.show`."""
        shell = _shell()
        super().__init__(world, open_site(port, is_framed=True), paused=shell is not None)
        self._height = height
        self._turns = None if shell is None else Turns(self, shell.events)
        world.run_by(self.run)
        world.resources.callback(self.close)

    def close(self) -> None:
        """Stop serving; the world runs on its own again."""
        if self._turns is not None:
            self._turns.end()
        self._world.run_by(None)
        super().close()

    def _repr_html_(self) -> str:
        """Return a frame with the page, at the name by which the notebook itself is reached."""
        address = html.escape(self.address)
        return (
            f'<iframe width="100%" height="{self._height}" style="border:0"></iframe>'
            f'<p><a href="{address}" target="_blank" rel="noreferrer">in a window of its own</a>'
            '</p><script>(() => {'
            'const frame = document.currentScript.parentElement.querySelector("iframe");'
            'const name = ["localhost", "127.0.0.1"].includes(location.hostname)'
            ' ? location.hostname : "127.0.0.1";'
            f'frame.src = {json.dumps(self.address)}.replace("127.0.0.1", name);'
            '})()</script>'
        )


class Turns:
    """Lets cells and the page take turns with a world; it begins within a cell."""

    def __init__(self, viewer: Viewer, events: _Events) -> None:
        self._viewer, self._events = viewer, events
        self.is_over = False
        self._is_free = threading.Event()  # no cell runs or waits
        self._owner = threading.Lock()
        self._has_cell = True
        self._owner.acquire()
        threading.Thread(target=self._run, name='world', daemon=True).start()
        events.register('pre_run_cell', self.begin_cell)
        events.register('post_run_cell', self.end_cell)

    def begin_cell(self, *_information: object) -> None:
        """Take the world from the page, once it has made its step."""
        if not self._has_cell:
            self._is_free.clear()
            self._owner.acquire()
            self._has_cell = True

    def end_cell(self, *_result: object) -> None:
        """Give the world to the page."""
        if self._has_cell:
            self._has_cell = False
            self._owner.release()
            self._is_free.set()

    def end(self) -> None:
        """Leave the world to cells from now on; idempotent."""
        if not self.is_over:
            self.is_over = True
            self._is_free.set()
            self._events.unregister('pre_run_cell', self.begin_cell)
            self._events.unregister('post_run_cell', self.end_cell)

    def _run(self) -> None:
        while not self.is_over:
            self._is_free.wait()
            with self._owner:
                if self._is_free.is_set() and not self.is_over:
                    self._viewer.turn()


def show(world: World, port: int = 0, height: int = 600) -> ShownViewer:
    """Show a world on a page; see `World.show`."""
    return ShownViewer(world, port, height)


def _shell() -> _Shell | None:
    """Return the shell of the notebook that runs this; None elsewhere."""
    ipython = sys.modules.get('IPython')  # a notebook has imported it
    return None if ipython is None else ipython.get_ipython()
