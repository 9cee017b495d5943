"""Drive to a goal in the room."""

import math
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, ClassVar

import numpy as np

from ...sim.rendering import Figure
from ..actions import Action
from ..env import Info, Observation
from ..observations import box
from ..parallel import make_parallel
from . import figures
from .driving import BUMPED, Driving

REACHED = 0.4  # [m] distance to the goal at which it is reached
# Where starts and goals are drawn: the free middle of the room, x and y [m].
_START = (-2.0, 2.0), (-1.0, 1.0)
_GOAL = (-2.2, 2.2), (-1.3, 1.3)
_LEAST_WAY = 1.0  # [m] from a start to its goal


class GoToGoal(Driving):
    """Drive to a goal in the room without touching what stands there.

    The observation adds `goal`: its distance [m], and the cosine and sine of its bearing. The
    reward is the way towards the goal [m], and 1 there. `options`: {'start': (x, y, yaw),
    'goal': (x, y)} in place of random ones [m, rad].
    """

    settings: ClassVar[dict[str, Any]] = {
        'world': 'room',
        'more': {'goal': box(3, (1e3, 1.0, 1.0))},
    }

    takes: ClassVar[dict[str, int]] = {'start': 3, 'goal': 2}

    def begin(self, options: Mapping[str, Any]) -> None:
        """Place the robot and its goal, where the robot can stand as well."""
        given = self.numbers(options)
        while True:
            goal = given.get('goal') or self.place_freely(*_GOAL)
            start = given.get('start') or self.place_freely(*_START)
            if math.dist(start[:2], goal[:2]) > _LEAST_WAY or given.keys() == {'start', 'goal'}:
                break
        self.goal = goal[:2]
        self.place(*start)
        self._left = self._distance()

    def observe(self) -> Observation:
        """Add the goal as the robot sees it."""
        x, y, yaw = self.pose
        bearing = math.atan2(self.goal[1] - y, self.goal[0] - x) - yaw
        goal = np.array((self._distance(), math.cos(bearing), math.sin(bearing)), np.float32)
        return {**super().observe(), 'goal': goal}

    def score(self, _observation: Observation, _action: Action) -> tuple[float, bool]:
        """Reward the way towards the goal."""
        before, self._left = self._left, self._distance()
        if self.bumps():
            return BUMPED, True
        return before - self._left + (self._left < REACHED), self._left < REACHED

    def truth(self) -> Info:
        """Add where the goal is, and whether it is reached."""
        return {**super().truth(), 'goal': np.array(self.goal), 'is_success': self._left < REACHED}

    def figures(self) -> Sequence[Figure]:
        """Return the goal, as large as it counts as reached."""
        return figures.goal(self.goal[0], self.goal[1], REACHED)

    def _distance(self) -> float:
        return math.dist(self.pose[:2], self.goal)


make_vec = partial(make_parallel, GoToGoal)
