"""Environments in parallel processes: the same bits, and what happens when a process dies."""

import os
import signal
import subprocess
import sys

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode
from support.patience import wait_until
from support.programs import is_running

import rosbots_description.gym  # noqa: F401  registers the tasks
from rosbots_description.gym import ParallelEnv, SimEnv, make_parallel
from rosbots_description.sim import NotFoundError, SimError


class Mortal(SimEnv):
    """Drive on; the process of the environment ends by itself in the step that is asked for."""

    def __init__(self, **options):
        super().__init__(**{'settle': 0.1, 'period': 0.05, **options})
        self.dies_at = self.raises_at = -1

    def begin(self, _options):
        self.step_count = 0
        self.place(*self.np_random.uniform(-1.0, 1.0, 3))

    def score(self, _observation, _action):
        self.step_count += 1
        if self.step_count == self.dies_at:
            os.kill(os.getpid(), signal.SIGKILL)
        if self.step_count == self.raises_at:
            raise ArithmeticError('the task is wrong')
        return 1.0, self.step_count == 7


class Idle(gymnasium.Env):
    """Without a world."""

    observation_space = action_space = gymnasium.spaces.Box(-1.0, 1.0, (1,))


def actions(envs, count):
    """Return the same random actions every time."""
    random = np.random.default_rng(3)
    return [random.uniform(-1.0, 1.0, envs.action_space.shape) for _ in range(count)]


def test_make_vec_gives_the_bits_of_single_environments_in_processes():
    envs = gymnasium.make_vec('rosbots/GoToGoal-v0', num_envs=2, max_episode_steps=4)
    assert isinstance(envs, ParallelEnv)
    assert len({process.pid for process in envs.processes} - {os.getpid()}) == 2
    observations, _ = envs.reset(seed=5)
    found = [observations] + [envs.step(action)[0] for action in actions(envs, 3)]
    truncated = envs.step(actions(envs, 4)[3])[3]
    assert truncated.all()
    for i in range(2):
        env = gymnasium.make('rosbots/GoToGoal-v0')
        alone = [env.reset(seed=5 + i)[0]]
        alone += [env.step(action[i])[0] for action in actions(envs, 3)]
        for one, other in zip(found, alone, strict=True):
            for name in other:
                assert one[name][i].tobytes() == other[name].tobytes()
        env.close()
    envs.close()
    assert not any(is_running(process.pid) for process in envs.processes)


def test_as_many_workers_for_each_core_keep_to_one_core_and_others_to_none():
    cores = sorted(os.sched_getaffinity(0))

    def allowed(count):
        envs = ParallelEnv(count * [Idle])
        found = [os.sched_getaffinity(process.pid) for process in envs.processes]
        envs.close()
        return found

    assert allowed(2 * len(cores)) == 2 * [{core} for core in cores]
    assert allowed(1) == [set(cores)]
    assert allowed(2 * len(cores) + 1)[0] == set(cores)
    assert os.sched_getaffinity(0) == set(cores)


def test_warnings_about_the_robot_come_once_and_none_from_the_console_of_a_worker(capfd):
    envs = make_parallel(Mortal, 3)
    _, infos = envs.reset(seed=0)
    envs.close()
    for faults in infos['faults']:
        assert any('contradict the collision geometry' in fault.what for fault in faults)
    assert capfd.readouterr().err.count('contradict the collision geometry') <= 1


@pytest.mark.parametrize('mode', list(AutoresetMode))
def test_worker_that_dies_is_replaced_and_the_others_go_on(mode, caplog):
    envs = make_parallel(Mortal, 2, autoreset_mode=mode)
    first, _ = envs.reset(seed=1)
    before = envs.processes[0].pid
    envs.set_attr('dies_at', [3, -1])
    begun = None
    for number, action in enumerate(actions(envs, 5), 1):
        observations, rewards, terminated, truncated, infos = envs.step(action)
        if number == 3:
            assert rewards.tolist() == [0.0, 1.0]
            assert truncated.tolist() == [True, False]
            assert not terminated.any()
            assert infos['worker_restarted'].tolist() == [True, False]
            begun = observations['odometry'][0].copy()
            assert np.abs(begun - first['odometry'][0]).max() > 0.01  # another episode
            if mode == AutoresetMode.DISABLED:
                envs.reset(options={'reset_mask': truncated})
        else:
            assert not truncated.any()
            resets = number == 4 and mode == AutoresetMode.NEXT_STEP
            assert rewards.tolist() == [0.0 if resets else 1.0, 1.0]
            if resets:
                assert np.array_equal(observations['odometry'][0], begun)
    assert envs.get_attr('step_count')[1] == 5
    assert envs.processes[0].pid != before
    assert f'process {before}) ended by SIGKILL; its episode is truncated' in caplog.text
    envs.close()


def test_worker_killed_between_two_steps_repeats_with_the_seed():
    found = []
    for _ in range(2):
        envs = make_parallel(Mortal, 2)
        envs.reset(seed=1)
        seen = []
        for number, action in enumerate(actions(envs, 6)):
            if number == 2:
                envs.processes[1].kill()
                envs.processes[1].join()
            observations, *_ = envs.step(action)
            seen.append(observations['odometry'].tobytes())
        found.append(seen)
        os.kill(envs.processes[0].pid, signal.SIGKILL)
        assert envs.get_attr('step_count') == (0, 2)  # the episode of the new process has begun
        assert envs.step(np.zeros((2, 2)))[3].tolist() == [True, False]
        os.kill(envs.processes[0].pid, signal.SIGKILL)
        assert envs.reset(seed=4)[1]['worker_restarted'].tolist() == [True, False]
        envs.close()
    assert found[0] == found[1]


def test_worker_that_dies_again_and_again_is_named():
    def dies():
        if os.getppid() == own and made:
            os._exit(3)
        return Mortal()

    own, made = os.getpid(), []
    envs = ParallelEnv([dies])
    made.append(True)
    envs.reset(seed=0)
    envs.processes[0].kill()
    with pytest.raises(SimError, match='died 5 times in a row'):
        envs.step(np.zeros((1, 2)))
    envs.close()


def test_what_a_task_raises_is_raised_here_and_the_environments_can_be_used_on(caplog):
    envs = make_parallel(Mortal, 2)
    envs.reset(seed=0)
    envs.set_attr('raises_at', [-1, 1])
    with pytest.raises(ArithmeticError, match='the task is wrong'):
        envs.step(np.zeros((2, 2)))
    observations, infos = envs.reset(seed=0)
    assert observations['odometry'].shape == (2, 6)
    assert infos['worker_restarted'].tolist() == [False, True]
    assert 'ended with code 0' in caplog.text
    for action, said in (
        (np.full((2, 2), np.nan), 'that at [0, 0] is nan'),
        (np.zeros((3, 2)), 'shape (2, 2)'),
        ('fast', 'shape (2, 2)'),
    ):
        with pytest.raises(ValueError, match='actions are') as error:
            envs.step(action)
        assert said in str(error.value)
    assert envs.step(np.zeros((2, 2)))[1].tolist() == [1.0, 1.0]
    envs.close()


def test_environments_that_cannot_be_made_are_named():
    with pytest.raises(NotFoundError, match='nowhere'):
        make_parallel(Mortal, 2, world='nowhere')
    with pytest.raises(SimError, match='num_envs is 0'):
        make_parallel(Mortal, 0)
    with pytest.raises(SimError, match='ended with code 3 while it was made'):
        ParallelEnv([lambda: os._exit(3)])


@pytest.mark.parametrize('mode', ['vector_entry_point', 'async'])
def test_no_worker_outlives_a_parent_that_is_killed(mode):
    program = (
        'import gymnasium, sys, time, rosbots_description.gym\n'
        "envs = gymnasium.make_vec('rosbots/Wander-v0', num_envs=3, settle=0.1,\n"
        f"                          vectorization_mode='{mode}')\n"
        'envs.reset(seed=0)\n'
        'print(*(process.pid for process in envs.processes), flush=True)\n'
        'while True: envs.step(envs.action_space.sample())\n'
    )
    with subprocess.Popen(
        [sys.executable, '-c', program],
        stdout=subprocess.PIPE,
        text=True,
        stderr=subprocess.DEVNULL,
        env={**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)},
    ) as parent:
        pids = [int(word) for word in parent.stdout.readline().split()]
        assert len(pids) == 3
        assert all(map(is_running, pids))
        parent.kill()
    wait_until(lambda: not any(map(is_running, pids)), 'the end of the workers')
