"""See as much of the rooms as possible without touching anything."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, ClassVar

from ...sim.rendering import Figure
from ..actions import Action
from ..env import Info, Observation
from ..parallel import make_parallel
from . import figures
from .driving import BUMPED, Driving

CELL = 0.5  # [m] edge of the squares that are visited
_START = (-3.0, 9.0), (-3.0, 6.0)  # the whole floor, x and y [m]


class Wander(Driving):
    """Drive through the rooms without touching anything.

    The reward is 1 for each square that the robot's frame visits first, 0.5 m wide. `options`:
    {'start': (x, y, yaw)} in place of a random one [m, rad].
    """

    settings: ClassVar[dict[str, Any]] = {'world': 'rooms'}

    def begin(self, options: Mapping[str, Any]) -> None:
        """Place the robot."""
        given = self.numbers(options)
        self.place(*(given.get('start') or self.place_freely(*_START)))
        self._visited = {self._cell()}

    def score(self, _observation: Observation, _action: Action) -> tuple[float, bool]:
        """Reward new squares."""
        cell = self._cell()
        is_new = cell not in self._visited
        self._visited.add(cell)
        if self.bumps():
            return BUMPED, True
        return float(is_new), False

    def truth(self) -> Info:
        """Add the area that was visited [m^2]."""
        return {**super().truth(), 'visited': len(self._visited) * CELL**2}

    def figures(self) -> Sequence[Figure]:
        """Return the squares that were visited."""
        return [figures.square(i * CELL, j * CELL, CELL) for i, j in sorted(self._visited)]

    def _cell(self) -> tuple[int, int]:
        x, y, _ = self.pose
        return round(x / CELL), round(y / CELL)


make_vec = partial(make_parallel, Wander)
