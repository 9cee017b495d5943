#!/usr/bin/env python3
"""Learn to drive to a goal by CMA-ES, without ROS and without a deep-learning library.

Each generation tries a few policies around the best guess, all of them from the same starts to the
same goals, and moves the guess towards the better ones (Hansen, The CMA Evolution Strategy: a
tutorial). follow_policy.py drives the robot in ROS by the result. Needs cma, gymnasium and
matplotlib.
"""

import argparse
import json
import logging
import multiprocessing
import time
from functools import cache
from pathlib import Path

import cma
import gymnasium
import numpy as np
from follow_policy import SECTORS, inputs, outputs
from matplotlib import pyplot

SHAPES = (5, SECTORS + 4), (2, 6)  # of the layers: outputs, and inputs with the bias
POPULATION, EPISODES = 16, 4  # policies in a generation, and episodes of each
DISCOUNT = 0.99  # of rewards, per control step: the sooner, the better
TESTS, TEST_SEED = 100, 1_000_000  # episodes of the test; the seeds of learning are below


@cache
def environment():
    """Return this process's own world."""
    logging.getLogger('rosbots_description').setLevel(logging.ERROR)  # the same for each world
    return gymnasium.make('rosbots_description.gym:rosbots/GoToGoal-v0', max_episode_steps=120)


def layers_of(weights):
    """Return the layers of a policy whose weights stand in one row."""
    ends = np.cumsum([rows * columns for rows, columns in SHAPES])
    return [
        part.reshape(shape)
        for part, shape in zip(np.split(weights, ends[:-1]), SHAPES, strict=True)
    ]


def episode(weights, seed):
    """Return the discounted rewards of an episode, and whether the robot reached the goal."""
    seen, info = environment().reset(seed=seed)
    total, weight, ended = 0.0, 1.0, False
    while not ended:
        action = outputs(layers_of(weights), inputs(seen['laser'], *seen['goal']))
        seen, reward, terminated, truncated, info = environment().step(action)
        total, weight = total + weight * reward, weight * DISCOUNT
        ended = terminated or truncated
    return total, info['is_success']


def learn(pool, generations, seed):
    """Return the weights, and time [s], mean return and share of successes of each generation."""
    guess = cma.CMAEvolutionStrategy(
        np.zeros(sum(map(np.prod, SHAPES))),
        0.5,
        {'popsize': POPULATION, 'seed': seed, 'verbose': -9},
    )
    begin, curve = time.monotonic(), []
    for generation in range(generations):
        seeds = range(generation * EPISODES, (generation + 1) * EPISODES)
        policies = guess.ask()
        results = np.array(
            pool.starmap(
                episode, [(policy, seed) for policy in policies for seed in seeds], chunksize=1
            )
        )
        returns, successes = results.reshape(POPULATION, EPISODES, 2).mean(axis=1).T
        guess.tell(policies, -returns)
        curve.append((time.monotonic() - begin, returns.mean(), successes.mean()))
        print('{:4.0f} s: return {:5.2f}, {:4.0%} reach the goal'.format(*curve[-1]), flush=True)
    return guess.result.xfavorite, np.array(curve)


def plot(curve, path):
    """Write a picture of the share of episodes that reach the goal, over all episodes so far."""
    episodes = np.arange(1, len(curve) + 1) * POPULATION * EPISODES
    figure, axes = pyplot.subplots(figsize=(6, 3.5), layout='constrained')
    axes.plot(episodes, 100.0 * curve[:, 2], marker='.')
    axes.set(xlabel='episodes', ylabel='of a generation, reach the goal [%]', ylim=(0.0, 100.0))
    axes.grid(alpha=0.3)
    figure.savefig(path, dpi=100)


def main():
    """Learn, test on starts and goals that were not learned from, and save policy and curve."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('policy', type=Path, help='JSON file to write')
    parser.add_argument('--curve', type=Path, help='picture to write')
    parser.add_argument('--generations', type=int, default=25)
    parser.add_argument('--seed', type=int, default=1, help='decides the result')
    parser.add_argument('--processes', type=int, help='default: one per core')
    options = parser.parse_args()
    with multiprocessing.get_context('spawn').Pool(options.processes) as pool:
        weights, curve = learn(pool, options.generations, options.seed)
        tests = pool.starmap(episode, [(weights, TEST_SEED + i) for i in range(TESTS)])
    print(f'test: {np.mean([success for _, success in tests]):.0%} of {TESTS} reach the goal')
    layers = [np.round(layer, 4).tolist() for layer in layers_of(weights)]
    options.policy.write_text(json.dumps({'layers': layers}) + '\n', encoding='utf-8')
    if options.curve:
        plot(curve, options.curve)


if __name__ == '__main__':
    main()
