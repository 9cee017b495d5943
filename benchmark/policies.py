"""Policies for the tasks of rosbots_description.gym: random, scripted, and learnt ones.

A maker takes the seed of an episode and returns a function from observations to actions: shares
of the greatest speed ahead and rate of turn to the left. Of the 361 rays of the laser, the first
looks to the right, the middle one ahead, and the last to the left.
"""

from __future__ import annotations

import json
import math
import runpy
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from article import ROOT
from numpy.typing import NDArray

Observation = Mapping[str, NDArray[Any]]
Action = NDArray[np.float32]
Policy = Callable[[Observation], Action]
Maker = Callable[[int], Policy]


def at_random(seed: int) -> Policy:
    """Draw each action uniformly."""
    draw = np.random.default_rng(seed)
    return lambda _seen: draw.uniform(-1.0, 1.0, 2).astype(np.float32)


def to_the_goal(_seed: int) -> Policy:
    """Turn to the goal and drive there, slower before obstacles, which push to the other side."""

    def policy(seen: Observation) -> Action:
        laser, (distance, ahead, left) = seen['laser'], seen['goal'].tolist()
        turn = 2.0 * left if ahead > 0.0 else math.copysign(1.0, left)
        push = _push(laser) if laser.min() < distance else 0.0
        room = min(_room(laser) - 0.4, distance)
        return _action((ahead > 0.8) * max(0.15, min(1.0, room)), turn + 1.5 * push)

    return policy


def where_there_is_room(_seed: int) -> Policy:
    """Drive ahead; before an obstacle turn to the side with more room until the way is free."""
    side = 0.0

    def policy(seen: Observation) -> Action:
        nonlocal side
        laser = seen['laser']
        if _room(laser) > 1.0:
            side = 0.0
            return _action(min(1.0, _room(laser) - 0.5), _push(laser))
        side = side or math.copysign(1.0, laser[200:].mean() - laser[:160].mean())
        return _action(0.0, side)

    return policy


def along_the_right_wall(_seed: int) -> Policy:
    """Follow the right wall."""

    def policy(seen: Observation) -> Action:
        laser = seen['laser']
        right = float((laser[:60] * np.cos(np.radians(np.arange(60) / 2.0))).min())
        if _room(laser) < 0.75:
            return _action(0.0, 1.0)
        return _action(0.5, max(-0.8, min(0.8, 1.6 * (0.85 - right))))

    return policy


def along_the_line(_seed: int) -> Policy:
    """Steer towards the yellow pixels of the lower half; search to the side where they were."""
    side = 1.0

    def policy(seen: Observation) -> Action:
        nonlocal side
        red, green, blue = seen['camera1'][120:].astype(int).transpose(2, 0, 1)
        columns = np.nonzero((red > blue + 60) & (green > blue + 60))[1]
        if not len(columns):
            return _action(0.0, side)
        left = 1.0 - float(columns.mean()) / 159.5
        side = math.copysign(1.0, left)
        return _action(1.0 - min(0.8, 1.2 * abs(left)), 1.5 * left)

    return policy


def learnt_by_cma(_seed: int) -> Policy:
    """Return the policy that scripts/learn_by_cma.py has learnt."""
    node = runpy.run_path(str(ROOT / 'scripts' / 'follow_policy.py'))
    layers = json.loads((ROOT / 'config' / 'go_to_goal_policy.json').read_text('utf-8'))['layers']
    return lambda seen: np.asarray(
        node['outputs'](layers, node['inputs'](seen['laser'], *seen['goal'])), np.float32
    )


def _room(laser: NDArray[Any]) -> float:
    """Return how far the robot can drive ahead, at its width [m]."""
    angles = np.linspace(-math.pi / 2.0, math.pi / 2.0, len(laser))
    in_way = np.abs(laser * np.sin(angles)) < 0.6  # [m] half of its width, and something
    return float((laser * np.cos(angles))[in_way].min(initial=10.0))


def _push(laser: NDArray[Any]) -> float:
    """Return a turn away from the nearer side."""
    half = len(laser) // 2
    return math.exp(-2.0 * float(laser[:half].min())) - math.exp(-2.0 * float(laser[half:].min()))


def _action(speed: float, turn: float) -> Action:
    return np.clip(np.array((speed, turn), np.float32), -1.0, 1.0)


POLICIES: dict[str, dict[str, Maker]] = {
    'GoToGoal': {'random': at_random, 'scripted': to_the_goal, 'learnt': learnt_by_cma},
    'FollowLine': {'random': at_random, 'scripted': along_the_line},
    'Wander': {'random': at_random, 'scripted': where_there_is_room},
    'Maze': {'random': at_random, 'scripted': along_the_right_wall},
}
