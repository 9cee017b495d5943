#!/usr/bin/env python3
"""Learn to drive to a goal by PPO of stable-baselines3: learn_by_cma.py with gradients.

Needs stable-baselines3, and with it PyTorch, which this project does not install.
"""

import argparse
import logging

import gymnasium
import numpy as np
from follow_policy import SECTORS, inputs
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.env_util import make_vec_env
from stable_baselines3.common.vec_env import SubprocVecEnv

TESTS, TEST_SEED = 100, 1_000_000  # episodes of the test; the seeds of learning are below


class Inputs(gymnasium.ObservationWrapper):
    """Observes what follow_policy.py gives its policies."""

    def __init__(self, environment):
        super().__init__(environment)
        self.observation_space = gymnasium.spaces.Box(-1.0, 1.0, (SECTORS + 3,), np.float32)

    def observation(self, seen):
        """Return the inputs of a policy."""
        return inputs(seen['laser'], *seen['goal']).astype(np.float32)


def environment():
    """Return a world with episodes of at most 15 s."""
    logging.getLogger('rosbots_description').setLevel(logging.ERROR)  # the same for each world
    return Inputs(
        gymnasium.make('rosbots_description.gym:rosbots/GoToGoal-v0', max_episode_steps=150)
    )


def reaches(model, world, seed):
    """Tell whether the policy reaches the goal of an episode."""
    seen, info = world.reset(seed=seed)
    ended = False
    while not ended:
        action, _ = model.predict(seen, deterministic=True)
        seen, _, terminated, truncated, info = world.step(action)
        ended = terminated or truncated
    return info['is_success']


class Progress(BaseCallback):
    """Tells how the learning goes."""

    def _on_step(self):
        return True

    def _on_rollout_end(self):
        episodes = self.model.ep_info_buffer
        print(
            f'{self.num_timesteps} steps: return {np.mean([one["r"] for one in episodes]):5.2f}, '
            f'{np.mean([one["is_success"] for one in episodes]):4.0%} reach the goal',
            flush=True,
        )


def main():
    """Learn, test on starts and goals that were not learned from, and save the policy."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('policy', help='file to write, for PPO.load')
    parser.add_argument('--steps', type=int, default=16_384, help='of control, to learn from')
    parser.add_argument('--worlds', type=int, default=2, help='in parallel, each a process')
    parser.add_argument('--seed', type=int, default=1)
    options = parser.parse_args()
    # The same steps, worlds and seed give the same policy on any machine with these packages.
    worlds = make_vec_env(
        environment,
        options.worlds,
        seed=options.seed,
        vec_env_cls=SubprocVecEnv,
        monitor_kwargs={'info_keywords': ('is_success',)},
    )
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
    world = environment()
    reached = sum(reaches(model, world, TEST_SEED + number) for number in range(TESTS))
    print(f'test: {reached} of {TESTS} episodes reach the goal')


if __name__ == '__main__':
    main()
