"""The motion of a world as one page that plays in any browser."""

import html
import os
from pathlib import Path
from typing import Self

from ..sim import SimError, World
from ..sim.runtime import NEVER, Hook, ShownWorld
from ..web import Recorder

RATE = 30.0  # motions in a second of simulated time
HEIGHT = 600  # of the page in a notebook [pixels]


class Recording(Hook):
    """Records until it is closed; it slows the simulation down, and does not change the motion.

    It ends by itself after two minutes of simulated time, or at 200 000 poses of links.
    """

    def __init__(self, world: World, path: str | os.PathLike[str] | None = None) -> None:
        """Begin; see `World.recording`.

        Raises:
            SimError: the folder of `path` does not exist.
        """
        self._path = None if path is None else Path(path)
        if self._path is not None and not self._path.parent.is_dir():
            raise SimError(f"there is no folder '{self._path.parent}' for the recording")
        self.html = b''  # when it is closed
        self._world, self._shown, self._recorder = world, ShownWorld(world), Recorder()
        self._period = max(1, round(1.0 / RATE / world.physics.step_size))  # [steps]
        self._is_open = True
        self._record()
        world.schedule.add(self)
        world.resources.callback(self.close)
        self.due = world.clock.steps + self._period

    def __enter__(self) -> Self:
        """Return the recording."""
        return self

    def __exit__(self, *_error: object) -> None:
        """End it."""
        self.close()

    def before_step(self) -> None:
        """Be due after this step, and again later."""
        self.runs_after_step = True
        self.due = self._world.clock.steps + self._period

    def after_step(self) -> None:
        """Record the poses."""
        self._record()
        if self._recorder.is_full:
            self.due = NEVER

    def close(self) -> None:
        """End, and write the file; idempotent.

        Raises:
            SimError: it cannot be written.
        """
        if not self._is_open:
            return
        self._is_open = False
        self._world.schedule.remove(self)
        self.html = self._recorder.finish()
        if self._path is not None:
            self.save(self._path)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the page as a file.

        Raises:
            SimError: the recording is not closed, or the file cannot be written.
        """
        if self._is_open:
            raise SimError(
                'this recording is not over; close it first, or use it in a with statement'
            )
        try:
            Path(path).write_bytes(self.html)
        except OSError as error:
            raise SimError(f"'{path}' cannot be written: {error.strerror}") from error

    def _repr_html_(self) -> str:
        """Return the page for a notebook, whose file it becomes part of."""
        if self._is_open:
            return '<p>This recording is not over.</p>'
        content = html.escape(self.html.decode('utf-8'))
        return (
            f'<iframe srcdoc="{content}" width="100%" height="{HEIGHT}" '
            'style="border:0" sandbox="allow-scripts"></iframe>'
        )

    def _record(self) -> None:
        change = self._shown.change()
        if change is not None:
            self._recorder.change(change)
        self._recorder.move(self._shown.motion(self._world.clock.now))
