"""A topic on the page: its checkbox, and what it says below it and in the scene."""

import time
from collections.abc import Callable

import numpy as np
import viser
from numpy.typing import NDArray

from ...sim.core import Pose, compose
from ...sim.description import ShownGrid, ShownReading
from ..controls import Rows, Words, plain
from ..scene import node, place, wxyz

RATE = 2e6  # of points and lines that are sent to a browser [bytes/s]
COLOUR = (230, 60, 40)  # of points without colours of their own
POINT = 0.02  # [m]
LIFT = 0.008  # [m] of a map above its plane, in which there is a ground that hid it in part
FLAT = (1.0, 0.0, 0.0, 0.0)  # a half turn about x: a picture's y axis points down
PIXELS = 1024  # along an edge of a map with fewer cells
PACKED = 20  # of a map's bytes, about one of so many is sent


class ReadingRow:
    """Shows a topic while its box is checked; not thread-safe."""

    def __init__(
        self,
        site: viser.ViserServer,
        topic: str,
        kind: str,
        checked: bool,
        choose: Callable[[], None],
    ) -> None:
        """Add the box; `choose` is called when a browser changes it."""
        self._site, self._topic = site, topic
        with site.atomic():  # nobody clicks before it is listened to
            self._box = site.gui.add_checkbox(
                plain(topic), checked, hint=f'{plain(topic)} ({plain(kind)})'
            )
            self._box.on_update(lambda _: choose())
        self._folder = site.gui.add_folder(plain(kind), visible=False)
        with self._folder:
            self._words = Words(site.gui)
        self._picture: viser.GuiImageHandle | None = None
        self._frame: viser.FrameHandle | None = None
        self._points: viser.PointCloudHandle | None = None
        self._lines: viser.LineSegmentsHandle | None = None
        self._next = 0.0  # when more may be sent [s, monotonic]

    @property
    def is_checked(self) -> bool:
        """Tell whether the box is checked."""
        return bool(self._box.value)

    def rank(self, number: int) -> None:
        """Be the row of that number, from 0."""
        self._box.order, self._folder.order = 2.0 * number, 2.0 * number + 1.0

    @property
    def is_ready(self) -> bool:
        """Tell whether browsers have had time for what was sent last."""
        return time.monotonic() >= self._next

    def show(self, reading: ShownReading, pose: Pose | None, note: str = '') -> None:
        """Show a reading, and a note below its words.

        Args:
            pose: of its frame in the world; None: what is in the scene is left out.
        """
        if reading.picture is not None:
            self._show_picture(reading.picture)
        if has_shape(reading) and pose is not None:
            with self._site.atomic():
                self._show_shape(reading, pose)
        self.say(reading, note)

    def say(self, reading: ShownReading, note: str = '') -> None:
        """Show the words and rows of a reading, and a note below its words."""
        self.tell(f'{reading.words}\n{note}' if note else reading.words, reading.rows)

    def move(self, pose: Pose) -> None:
        """Let the frame of what is in the scene have another pose in the world."""
        if self._frame is not None:
            place(self._frame, pose)

    def tell(self, words: str, rows: Rows = ()) -> None:
        """Show words below the box."""
        self._folder.visible = True
        self._words.show(words, rows)

    def clear(self) -> None:
        """Show the box only."""
        self._folder.visible = False
        self._words.show('')
        for part in (self._picture, self._frame):
            if part is not None:
                part.remove()
        self._picture = self._frame = self._points = self._lines = None

    def remove(self) -> None:
        """Remove all of it from the page."""
        self.clear()
        self._folder.remove()
        self._box.remove()

    def _show_picture(self, picture: NDArray[np.uint8]) -> None:
        if self._picture is None:
            with self._folder:
                self._picture = self._site.gui.add_image(picture, format='jpeg', jpeg_quality=80)
        else:
            self._picture.image = picture

    def _show_shape(self, reading: ShownReading, pose: Pose) -> None:
        scene, name = self._site.scene, f'/readings/{node(self._topic)}'
        if self._frame is None:
            self._frame = scene.add_frame(name, show_axes=False)
        place(self._frame, pose)
        sent = 0
        if reading.points is not None:
            colours = COLOUR if reading.colours is None else reading.colours
            if self._points is None or reading.colours is not None:
                self._points = scene.add_point_cloud(
                    f'{name}/points',
                    reading.points,
                    colours,
                    point_size=POINT,
                    point_shape='circle',
                )
            else:
                self._points.points = reading.points.astype(np.float16)
            sent += reading.points.nbytes
        if reading.lines is not None:
            if self._lines is None:
                self._lines = scene.add_line_segments(
                    f'{name}/lines',
                    reading.lines,
                    reading.line_colour,
                    thickness=reading.line_width,
                    thickness_units='screen',
                )
            else:
                self._lines.points = reading.lines
            sent += reading.lines.nbytes
        if reading.grid is not None:
            sent += self._show_grid(reading.grid, f'{name}/grid')
        self._next = time.monotonic() + sent / RATE

    def _show_grid(self, grid: ShownGrid, name: str) -> int:
        """Draw a map; return how much of it was sent [bytes], about."""
        rows, columns = grid.cells.shape[:2]
        size = grid.cell * columns, grid.cell * rows
        centre = compose(grid.origin, Pose((size[0] / 2.0, size[1] / 2.0, LIFT), FLAT))
        # Browsers blur a picture: a cell has some pixels, so that its edges are seen.
        pixels = max(1, PIXELS // max(rows, columns))
        self._site.scene.add_image(
            name,
            grid.cells.repeat(pixels, axis=0).repeat(pixels, axis=1),
            *size,
            format='png',
            cast_shadow=False,
            receive_shadow=False,
            position=centre.position,
            wxyz=wxyz(centre),
        )
        return grid.cells.nbytes // PACKED


def has_shape(reading: ShownReading) -> bool:
    """Tell whether any of it is in the scene."""
    return any(part is not None for part in (reading.points, reading.lines, reading.grid))
