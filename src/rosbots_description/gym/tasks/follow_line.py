"""Follow the yellow line by the camera."""

import math
from collections.abc import Mapping
from functools import cached_property, partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ...sim import World, yaw_of
from ...sim.description import Box
from ..actions import Action
from ..env import Info, Observation
from ..parallel import make_parallel
from ..placement import Place
from .driving import BUMPED, Driving

LOST = 0.5  # [m] distance from the line at which it is lost, which ends the episode
_ASTRAY = 0.5  # share of a reward that is lost there
_START_SHIFT, _START_TURN = 0.15, 0.3  # greatest at the start: to the side [m], and in yaw [rad]


class Line:
    """A closed line of pieces on the ground, in their order."""

    def __init__(self, world: World) -> None:
        """Read the pieces: the boxes of the model 'line', which lie along their x axes."""
        visuals = world.model('line').link('link').spec.visuals
        boxes = [
            (one.pose, one.geometry.size[0]) for one in visuals if isinstance(one.geometry, Box)
        ]
        self._middles = np.array([pose.position[:2] for pose, _ in boxes])
        self._yaws = np.array([yaw_of(pose.orientation) for pose, _ in boxes])
        self._lengths = np.array([length for _, length in boxes])
        self._ahead = np.stack((np.cos(self._yaws), np.sin(self._yaws)), axis=1)
        self._before = np.cumsum(self._lengths) - self._lengths
        self.length = float(self._lengths.sum())

    @property
    def pieces(self) -> int:
        """Return how many there are."""
        return len(self._yaws)

    def place(self, piece: int) -> Place:
        """Return the middle of a piece, x and y [m], and its yaw [rad]."""
        x, y = self._middles[piece].tolist()
        return x, y, float(self._yaws[piece])

    def nearest(self, x: float, y: float) -> tuple[float, float]:
        """Return the nearest point's way along the line, and its distance [m]."""
        offsets: NDArray[np.float64] = np.array((x, y)) - self._middles
        along = (offsets * self._ahead).sum(axis=1)
        along = np.clip(along, -self._lengths / 2.0, self._lengths / 2.0)
        apart = np.linalg.norm(offsets - along[:, None] * self._ahead, axis=1)
        piece = int(np.argmin(apart))
        way = self._before[piece] + self._lengths[piece] / 2.0 + along[piece]
        return float(way), float(apart[piece])


class FollowLine(Driving):
    """Follow the yellow line by the camera, which looks down ahead of the robot.

    The reward is the way along the line [m], less up to half of it beside the line; losing the line
    costs 1 and ends the episode. `options`: {'start': (x, y, yaw)} in place of a random one on the
    line [m, rad].
    """

    settings: ClassVar[dict[str, Any]] = {
        'world': 'line',
        'arguments': {'camera': 'true', 'camera_pitch': '0.6'},
        'sensors': ['camera1', 'odometry'],
    }

    def begin(self, options: Mapping[str, Any]) -> None:
        """Place the robot on the line."""
        shift, turn = self.np_random.uniform(-1.0, 1.0, 2) * (_START_SHIFT, _START_TURN)
        x, y, yaw = self._line.place(int(self.np_random.integers(self._line.pieces)))
        start = (x - shift * math.sin(yaw), y + shift * math.cos(yaw), yaw + turn)
        self.place(*self.numbers(options).get('start', start))
        self._way, self._apart = self._line.nearest(*self.pose[:2])
        self._driven = 0.0

    @cached_property
    def _line(self) -> Line:
        return Line(self.world)

    def score(self, _observation: Observation, _action: Action) -> tuple[float, bool]:
        """Reward the way along the line."""
        before, (self._way, self._apart) = self._way, self._line.nearest(*self.pose[:2])
        half = self._line.length / 2.0
        ahead = (self._way - before + half) % self._line.length - half  # around the closed line
        self._driven += ahead
        if self._apart > LOST:
            return BUMPED, True
        return ahead * (1.0 - _ASTRAY * self._apart / LOST), False

    def truth(self) -> Info:
        """Add the distance from the line, and the way driven along it [m]."""
        return {**super().truth(), 'line_distance': self._apart, 'driven': self._driven}


make_vec = partial(make_parallel, FollowLine)
