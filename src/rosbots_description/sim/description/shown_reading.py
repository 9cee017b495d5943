"""What a sensor has sensed, as a window shows it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class ShownReading:
    """A picture, a shape in the scene, or words: whatever there is.

    `picture` is (height, width, 3), RGB. `points` (n, 3) and `lines` (n, 2, 3) are in `frame` [m];
    `colours` (n, 3), RGB, are those of the points. `words` are lines of text,
    `rows` names with what they have.
    """

    frame: str = ''
    picture: NDArray[np.uint8] | None = None
    points: NDArray[np.float32] | None = None
    colours: NDArray[np.uint8] | None = None
    lines: NDArray[np.float32] | None = None
    words: str = ''
    rows: tuple[tuple[str, str], ...] = ()
