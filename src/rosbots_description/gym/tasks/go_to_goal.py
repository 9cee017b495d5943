"""Drive to a goal in the room."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..env import Info, Observation, SimEnv
from ..observations import box

REACHED = 0.4  # [m] distance to the goal at which it is reached
BUMPED = -1.0  # reward for touching something that stands, which ends the episode
# Where starts and goals are drawn: the free middle of the room, x and y from -most to most [m].
_START, _GOAL = (2.0, 1.0), (2.2, 1.3)
_LEAST_WAY = 1.0  # [m] from a start to its goal
_COLUMN, _CLEAR = (1.8, -1.2), 1.3  # [m] its centre, and the distance that is kept from it


class GoToGoal(SimEnv):
    """Drive to a goal in the room without touching what stands there.

    The observation adds `goal`: its distance [m], and the cosine and sine of its bearing. The
    reward is the way towards the goal [m], and 1 there. `options`: {'start': (x, y, yaw),
    'goal': (x, y)} in place of random ones [m, rad].
    """

    def __init__(self, **options: Any) -> None:  # noqa: ANN401  those of SimEnv
        """Load the room; the arguments are those of `SimEnv`."""
        settings: dict[str, Any] = {
            'world': 'room', 'arguments': {'laser': 'true'}, 'sensors': ['laser', 'odometry'],
            'actions': {'differential_drive_controller': (0.8, 0.8)},
            'more': {'goal': box(3, (1e3, 1.0, 1.0))}}
        super().__init__(**settings | options)

    def begin(self, options: Mapping[str, Any]) -> None:
        """Place the robot and its goal."""
        while True:
            start = self.np_random.uniform(-1.0, 1.0, 2) * _START
            goal = self.np_random.uniform(-1.0, 1.0, 2) * _GOAL
            yaw = self.np_random.uniform(-math.pi, math.pi)
            if math.dist(start, goal) > _LEAST_WAY and min(
                    math.dist(start, _COLUMN), math.dist(goal, _COLUMN)) > _CLEAR:
                break
        x, y, yaw = options.get('start', (*start, yaw))
        self.goal = np.array(options.get('goal', goal), float)
        self.place(x, y, yaw)
        self._left = self._distance()

    def observe(self) -> Observation:
        """Add the goal as the robot sees it."""
        pose = self.pose
        dx, dy = self.goal - pose[:2]
        bearing = math.atan2(dy, dx) - pose[2]
        goal = np.array((math.hypot(dx, dy), math.cos(bearing), math.sin(bearing)), np.float32)
        return {**super().observe(), 'goal': goal}

    def score(self, _observation: Observation, _action: Any) -> tuple[float, bool]:  # noqa: ANN401
        """Reward the way towards the goal."""
        before, self._left = self._left, self._distance()
        if self.bumps():
            return BUMPED, True
        return before - self._left + (self._left < REACHED), self._left < REACHED

    def truth(self) -> Info:
        """Add where the goal is, and whether it is reached."""
        return {**super().truth(), 'goal': self.goal.copy(), 'is_success': self._left < REACHED}

    def _distance(self) -> float:
        x, y, _ = self.pose
        return math.dist((x, y), self.goal)
