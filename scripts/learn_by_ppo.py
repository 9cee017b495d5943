#!/usr/bin/env python3
"""Learn a task by PPO of stable-baselines3: learn_by_cma.py with gradients, for all tasks.

Needs stable-baselines3, and with it PyTorch, which this project does not install.
"""

import argparse
import logging
from functools import partial

import gymnasium
import numpy as np
import torch
from follow_policy import SECTORS, inputs
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.env_util import make_vec_env
from stable_baselines3.common.vec_env import SubprocVecEnv

TEST_SEED = 1_000_000  # of the first episode of the test; the seeds of learning are below


def yellow(picture):
    """Return which share of each sector is yellow in the lower half of a picture."""
    red, green, blue = picture[len(picture) // 2 :].astype(int).transpose(2, 0, 1)
    is_yellow = (red > blue + 60) & (green > blue + 60)
    return [part.mean() for part in np.array_split(is_yellow, SECTORS, axis=1)]


# What a policy sees, from -1 to 1; control steps of an episode (None: all of the task's), and
# episodes of the test.
TASKS = {
    'GoToGoal': (lambda seen: inputs(seen['laser'], *seen['goal']), 150, 100),
    'FollowLine': (lambda seen: yellow(seen['camera1']), None, 20),
    'Wander': (lambda seen: inputs(seen['laser'], 0.0, 0.0, 0.0)[:SECTORS], None, 20),
    'Maze': (lambda seen: inputs(seen['laser'], 0.0, 0.0, 0.0)[:SECTORS], None, 20),
}


class Inputs(gymnasium.ObservationWrapper):
    """Observes the few numbers that a policy sees."""

    def __init__(self, environment, seen_by_policy):
        super().__init__(environment)
        self._seen_by_policy = seen_by_policy
        size = SECTORS + 3 * ('goal' in environment.observation_space.spaces)
        self.observation_space = gymnasium.spaces.Box(-1.0, 1.0, (size,), np.float32)

    def observation(self, seen):
        """Return the inputs of a policy."""
        return np.array(self._seen_by_policy(seen), np.float32)


def environment(task):
    """Return a world with a task."""
    logging.getLogger('rosbots_description').setLevel(logging.ERROR)  # the same for each world
    seen_by_policy, steps, _ = TASKS[task]
    name = f'rosbots_description.gym:rosbots/{task}-v0'
    return Inputs(gymnasium.make(name, max_episode_steps=steps), seen_by_policy)


def episode(model, world, seed):
    """Return the sum of the rewards of an episode, and whether the goal was reached, if any."""
    seen, info = world.reset(seed=seed)
    total, ended = 0.0, False
    while not ended:
        action, _ = model.predict(seen, deterministic=True)
        seen, reward, terminated, truncated, info = world.step(action)
        total, ended = total + reward, terminated or truncated
    return total, info.get('is_success')


class Progress(BaseCallback):
    """Tells how the learning goes."""

    def _on_step(self):
        return True

    def _on_rollout_end(self):
        returns = [one['r'] for one in self.model.ep_info_buffer]
        print(f'{self.num_timesteps} steps: return {np.mean(returns):5.2f}', flush=True)


def main():
    """Learn, save the policy, and test it in episodes that it has not learned from."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('policy', help='file to write, for PPO.load')
    parser.add_argument('--task', choices=TASKS, default='GoToGoal')
    parser.add_argument('--steps', type=int, default=16_384, help='of control, to learn from')
    parser.add_argument('--worlds', type=int, default=2, help='in parallel, each a process')
    parser.add_argument('--seed', type=int, default=1)
    options = parser.parse_args()
    # The same steps, worlds and seed give the same policy on any machine with these packages: with
    # more threads, which cost a small policy time, sums are made in another order.
    torch.set_num_threads(1)
    make = partial(environment, options.task)
    worlds = make_vec_env(make, options.worlds, seed=options.seed, vec_env_cls=SubprocVecEnv)
    model = PPO(
        'MlpPolicy',
        worlds,
        n_steps=1024 // options.worlds,
        gamma=0.98,
        seed=options.seed,
        device='cpu',
    )
    model.learn(options.steps, Progress())
    model.save(options.policy)
    worlds.close()
    world, tests = make(), TASKS[options.task][2]
    results = [episode(model, world, TEST_SEED + number) for number in range(tests)]
    totals, reached = zip(*results, strict=True)
    successes = '' if None in reached else f', {np.mean(reached):.0%} reach the goal'
    print(
        f'test: return {np.mean(totals):.2f} ± {np.std(totals):.2f} in {tests} episodes{successes}'
    )


if __name__ == '__main__':
    main()
