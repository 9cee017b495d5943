"""The registered tasks: what is rewarded, and what ends an episode."""

import math

import gymnasium
import numpy as np
import pytest

import rosbots_description.gym  # noqa: F401  registers the tasks

AHEAD = np.array([1.0, 0.0])


@pytest.fixture
def task(request):
    env = gymnasium.make(f'rosbots/{request.param}-v0')
    yield env
    env.close()


def drive(env, action, steps):
    """Return the sum of rewards, whether the task ended, and the last info."""
    rewards, terminated, info = [], False, {}
    while not terminated and len(rewards) < steps:
        _, reward, terminated, _, info = env.step(action)
        rewards.append(reward)
    return sum(rewards), terminated, info


def assert_arrives(env, reward):
    """Assert that the robot reaches the goal straight ahead, for a sum of rewards."""
    total, terminated, info = drive(env, AHEAD, 60)
    assert terminated
    assert info['is_success']
    assert total == pytest.approx(reward, abs=0.1)


@pytest.mark.parametrize('task', ['GoToGoal'], indirect=True)
def test_goal_ahead_is_reached_and_the_way_is_rewarded(task):
    observation, info = task.reset(seed=0, options={'start': (-1.0, 0.0, 0.0), 'goal': (1.0, 0.0)})
    assert observation['goal'] == pytest.approx((2.0, 1.0, 0.0), abs=1e-3)
    assert not info['is_success']
    assert_arrives(task, 1.0 + 2.0 - 0.4)
    observation, _ = task.reset(options={'start': (1.0, 0.5, 0.3), 'goal': (-0.5, -1.0)})
    bearing = math.atan2(-1.5, -1.5) - 0.3
    assert observation['goal'] == pytest.approx(
        (math.hypot(1.5, 1.5), math.cos(bearing), math.sin(bearing)), abs=0.02
    )


@pytest.mark.parametrize('task', ['GoToGoal'], indirect=True)
def test_touching_the_wall_ends_the_episode_and_the_seed_decides_its_start(task):
    task.reset(options={'start': (1.0, 1.0, math.pi / 2.0), 'goal': (-1.0, 0.0)})
    total, terminated, info = drive(task, AHEAD, 60)
    assert (terminated, info['is_success']) == (True, False)
    assert total < -1.0
    starts = [task.reset(seed=seed)[1] for seed in (1, 2, 1)]
    assert np.array_equal(starts[0]['pose'], starts[2]['pose'])
    assert not np.array_equal(starts[0]['pose'], starts[1]['pose'])
    for start in starts:
        assert math.dist(start['pose'][:2], start['goal']) > 1.0


@pytest.mark.parametrize('task', ['FollowLine'], indirect=True)
def test_way_along_the_line_is_rewarded_until_the_line_is_lost(task):
    task.reset(seed=0, options={'start': (-1.0, 0.0, 0.0)})
    total, terminated, info = drive(task, AHEAD, 25)
    assert not terminated
    assert info['line_distance'] < 0.1
    assert total == pytest.approx(info['driven'], rel=0.1)
    assert total > 1.0
    total, terminated, info = drive(task, AHEAD, 60)  # straight on, where the line bends
    assert terminated
    assert info['line_distance'] > 0.5


@pytest.mark.parametrize('task', ['Wander'], indirect=True)
def test_new_squares_are_rewarded_once(task):
    _, info = task.reset(seed=0, options={'start': (-1.0, 0.0, 0.0)})
    assert info['visited'] == 0.25
    total, terminated, info = drive(task, AHEAD, 30)
    assert not terminated
    assert total == pytest.approx(4.0, abs=1.0)
    assert info['visited'] == 0.25 * (1.0 + total)
    total, terminated, _ = drive(task, -AHEAD, 25)
    assert (total, terminated) == (0.0, False)


@pytest.mark.parametrize('task', ['Maze'], indirect=True)
def test_what_the_way_out_becomes_shorter_is_rewarded(task):
    _, info = task.reset(seed=0)
    assert 20.0 < info['left'] < 100.0
    places = {
        (x, y): task.reset(options={'start': (x, y, 0.0)})[1]['left']
        for x in range(-6, 7, 2)
        for y in range(-6, 7, 2)
    }
    assert all(map(math.isfinite, places.values()))
    assert places[6, 6] == 2.0  # the last cell; the goal is in the next one
    assert max(abs(places[x, y] - places[x + 2, y]) for x, y in places if x < 6) > 2.0  # walls
    task.reset(options={'start': (6.0, 6.0, 0.0)})
    assert_arrives(task, 10.0 + 2.0 - 0.7)


@pytest.mark.parametrize('task', ['GoToGoal'], indirect=True)
def test_option_that_cannot_be_is_named(task):
    for options, said in (
        ({'strat': (0, 0, 0)}, "no option 'strat'; GoToGoal takes start, goal"),
        ({'goal': (1.0, 2.0, 3.0)}, "'goal' takes 2 finite numbers"),
        ({'start': 'here'}, "'start' takes 3 finite numbers; it got 'here'"),
        ({'start': (0.0, 0.0, math.nan)}, '3 finite numbers'),
    ):
        with pytest.raises(ValueError, match='option') as error:
            task.reset(options=options)
        assert said in str(error.value)
