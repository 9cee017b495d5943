#!/usr/bin/env python3
"""Measure the returns of random, scripted and learnt policies in the tasks of Gymnasium.

A return is the sum of the rewards of an episode, not discounted. Episode k has the seed k, so a
policy has the same returns on any machine. The arguments are the number of episodes of each policy
(default 20), and tasks (default: all). The table is that of doc/gym.md.
"""

from __future__ import annotations

import logging
import multiprocessing
import os
import sys
from collections.abc import Sequence
from functools import cache
from typing import Any, NamedTuple

import gymnasium
import numpy as np
from policies import POLICIES

EPISODES = 20
HEADER = (
    '| Task | Policy | Return | Its standard deviation | Steps | Success |\n'
    '| --- | --- | --- | --- | --- | --- |'
)


class Episode(NamedTuple):
    """The result of an episode; `success` is None in tasks without a goal."""

    total: float
    steps: int
    success: bool | None


@cache
def environment(task: str) -> gymnasium.Env[Any, Any]:
    """Return this process's environment of a task."""
    logging.getLogger('rosbots_description').setLevel(logging.ERROR)
    return gymnasium.make(f'rosbots_description.gym:rosbots/{task}-v0')


def episode(task: str, policy: str, seed: int) -> Episode:
    """Run an episode."""
    env = environment(task)
    act, total, steps, ended = POLICIES[task][policy](seed), 0.0, 0, False
    seen, info = env.reset(seed=seed)
    while not ended:
        seen, reward, terminated, truncated, info = env.step(act(seen))
        total, steps, ended = total + float(reward), steps + 1, terminated or truncated
    return Episode(total, steps, info.get('is_success'))


def row(task: str, policy: str, results: Sequence[Episode]) -> str:
    """Return a row of the table."""
    returns = np.array([one.total for one in results])
    reached = [one.success for one in results if one.success is not None]
    success = f'{np.mean(reached):.0%}' if reached else '-'
    return (
        f'| {task} | {policy} | {returns.mean():.2f} | {returns.std():.2f} '
        f'| {np.mean([one.steps for one in results]):.0f} | {success} |'
    )


def main() -> int:
    """Print the table, a row as soon as it is measured; return the exit code."""
    numbers = [int(one) for one in sys.argv[1:] if one.isdecimal()]
    tasks = [one for one in sys.argv[1:] if not one.isdecimal()] or [*POLICIES]
    unknown = [task for task in tasks if task not in POLICIES]
    if unknown or len(numbers) > 1 or 0 in numbers:
        print(
            f'arguments are a number of episodes, and tasks: {", ".join(POLICIES)}', file=sys.stderr
        )
        return 2
    episodes = numbers[0] if numbers else EPISODES
    print(f'{episodes} episodes of each policy\n\n{HEADER}')
    with multiprocessing.get_context('spawn').Pool(len(os.sched_getaffinity(0))) as pool:
        for task in tasks:
            for policy in POLICIES[task]:
                results = pool.starmap(
                    episode, [(task, policy, seed) for seed in range(episodes)], chunksize=1
                )
                print(row(task, policy, results))
    return 0


if __name__ == '__main__':
    sys.exit(main())
