"""A box around what is selected in a browser."""

import numpy as np
import viser

from ...sim.description import SceneChange, ShownLink
from ..controls import Panel
from .bounds import corners
from .nodes import link_node
from .selection import Selection

COLOUR = (255, 140, 0)
WIDTH = 2.0  # of its lines [pixels]
MOST = 200  # links of one model that get a box
GAP = 0.003  # between the box and what it is around [m]
# Edges of a box: pairs of opposite ends along each axis, of a cube from -1 to 1.
_ENDS = [(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]
EDGES = np.array(
    [
        (one, other)
        for one in _ENDS
        for other in _ENDS
        if one < other and sum(x != y for x, y in zip(one, other, strict=True)) == 1
    ]
)


class Outline(Panel):
    """Shows a box around each selected link; it moves along as a part of the link's node."""

    def __init__(self, client: viser.ClientHandle, selection: Selection) -> None:
        self._scene, self._selection = client.scene, selection
        self._shown: list[str] = []
        selection.on_change(self.draw)

    def apply(self, change: SceneChange) -> None:
        """Draw it again around a model that has changed."""
        if self._selection.is_in(change):
            self.draw()

    def draw(self) -> None:
        """Draw the boxes, instead of those before."""
        for name in self._shown:
            self._scene.remove_by_name(name)  # unless it went with its link
        self._shown = []
        if self._selection.model is not None:
            for link in self._selection.links[:MOST]:
                self._add(f'{link_node(self._selection.model, link.name)}/selected', link)

    def _add(self, name: str, link: ShownLink) -> None:
        points = corners(link.visuals)
        if points:
            low, high = np.min(points, axis=0) - GAP, np.max(points, axis=0) + GAP
            self._scene.add_line_segments(
                name,
                (low + high) / 2.0 + EDGES * (high - low) / 2.0,
                COLOUR,
                thickness=WIDTH,
                thickness_units='screen',
            )
            self._shown.append(name)
