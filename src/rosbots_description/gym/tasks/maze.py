"""Find the way out of the maze."""

import math
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property, partial
from typing import Any, ClassVar

from ...sim import World
from ...sim.description import Box
from ...sim.rendering import Figure
from ..actions import Action
from ..env import Info, Observation
from ..parallel import make_parallel
from . import figures
from .driving import BUMPED, Driving

GOAL = (8.0, 6.0)  # [m] the green spot, outside the only door
REACHED = 0.7  # [m] distance from there at which it is reached
_CELL = 2.0  # [m]
_SIDE = range(-3, 5)  # columns and rows of cells, and one outside that holds the goal

Cell = tuple[int, int]


class Distances:
    """The length of the shortest way from anywhere in the maze to the goal, by cells."""

    def __init__(self, world: World) -> None:
        """Read the walls of the model 'maze', which lie along x and y."""
        link = world.model('maze').link('link')
        self._walls = [
            (x, y, one.spec.geometry.size[0] / 2.0, one.spec.geometry.size[1] / 2.0)
            for one in link.collisions.values()
            if isinstance(one.spec.geometry, Box)
            for x, y, _ in [one.pose.position]
        ]
        self._ways: dict[Cell, float] = {_cell(*GOAL): 0.0}
        queue = deque(self._ways)  # the nearest cells first
        while queue:
            cell = queue.popleft()
            for near in self._neighbours(cell):
                if near not in self._ways:
                    self._ways[near] = self._ways[cell] + _CELL
                    queue.append(near)

    def of(self, x: float, y: float) -> float:
        """Return the way from a point to the goal [m]; inf where there is none."""
        cell = _cell(x, y)
        return min(
            (
                self._ways.get(one, math.inf) + math.dist((x, y), _middle(one))
                for one in (cell, *self._neighbours(cell))
            ),
            default=math.inf,
        )

    def _neighbours(self, cell: Cell) -> Iterator[Cell]:
        column, row = cell
        for near in ((column + 1, row), (column - 1, row), (column, row + 1), (column, row - 1)):
            if near[0] in _SIDE and near[1] in _SIDE and not self._is_walled(cell, near):
                yield near

    def _is_walled(self, cell: Cell, near: Cell) -> bool:
        (ax, ay), (bx, by) = _middle(cell), _middle(near)
        x, y = (ax + bx) / 2.0, (ay + by) / 2.0
        return any(
            abs(x - wall_x) <= half_x and abs(y - wall_y) <= half_y
            for wall_x, wall_y, half_x, half_y in self._walls
        )


class Maze(Driving):
    """Find the way from the middle of the maze to the green spot outside, without touching a wall.

    The reward is what the shortest way has become shorter [m], and 10 at its end. `options`:
    {'start': (x, y, yaw)} in place of the middle and a random yaw [m, rad].
    """

    settings: ClassVar[dict[str, Any]] = {'world': 'maze'}

    def begin(self, options: Mapping[str, Any]) -> None:
        """Place the robot."""
        start = (0.0, 0.0, self.np_random.uniform(-math.pi, math.pi))
        self.place(*self.numbers(options).get('start', start))
        self._left = self._distances.of(*self.pose[:2])

    def score(self, _observation: Observation, _action: Action) -> tuple[float, bool]:
        """Reward what the way has become shorter."""
        before, self._left = self._left, self._distances.of(*self.pose[:2])
        if self.bumps():
            return BUMPED, True
        return before - self._left + 10.0 * self._is_out, self._is_out

    def truth(self) -> Info:
        """Add the shortest way that is left [m], and whether the robot is out."""
        return {**super().truth(), 'left': self._left, 'is_success': self._is_out}

    def figures(self) -> Sequence[Figure]:
        """Return the goal outside, as large as it counts as reached."""
        return figures.goal(*GOAL, REACHED)

    @cached_property
    def _distances(self) -> Distances:
        return Distances(self.world)

    @property
    def _is_out(self) -> bool:
        return math.dist(self.pose[:2], GOAL) < REACHED


def _cell(x: float, y: float) -> Cell:
    return round(x / _CELL), round(y / _CELL)


def _middle(cell: Cell) -> tuple[float, float]:
    return cell[0] * _CELL, cell[1] * _CELL


make_vec = partial(make_parallel, Maze)
