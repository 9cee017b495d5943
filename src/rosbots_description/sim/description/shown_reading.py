"""What a topic says, as a window shows it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core import IDENTITY, Pose

RAY: tuple[int, int, int] = (255, 160, 140)


@dataclass(frozen=True)
class ShownGrid:
    """A map that lies flat.

    `cells` (height, width, 4) are RGBA, the row at the greatest y first; `cell` is the edge of each
    [m]; `origin` is the pose of the outer corner at the lowest x and y.
    """

    cells: NDArray[np.uint8]
    cell: float
    origin: Pose = IDENTITY


@dataclass(frozen=True)
class ShownReading:
    """A picture, a shape in the scene, or words: whatever there is.

    `picture` is (height, width, 3), RGB. `grid`, `points` (n, 3) and `lines` (n, 2, 3) are in
    `frame` [m]; `colours` (n, 3), RGB, are those of the points, `line_colour` that of the
    lines, `line_width` their width [pixels]. `words` are lines of text, `rows` names with what
    they have.
    """

    frame: str = ''
    picture: NDArray[np.uint8] | None = None
    grid: ShownGrid | None = None
    points: NDArray[np.float32] | None = None
    colours: NDArray[np.uint8] | None = None
    lines: NDArray[np.float32] | None = None
    line_colour: tuple[int, int, int] = RAY
    line_width: float = 1.0
    words: str = ''
    rows: tuple[tuple[str, str], ...] = ()
