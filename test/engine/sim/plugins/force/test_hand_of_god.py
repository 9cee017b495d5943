"""The hand of god: as recorded in Gazebo, and stable for any link."""

import itertools
import logging
import math

import pytest
from support.fake_drive import collect
from support.recorded import DATA, load

from rosbots_description.sim.core.transforms import (
    Pose,
    compose,
    conjugate,
    from_rpy,
    multiply,
)
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.runtime.scheduler import NEVER

GOAL = Pose((1.0, 0.0, 1.0))
AFTER = 23  # steps from the first transform to the first recorded state
LATE = 0.02  # [m/s] change of a velocity within 1 ms, between reading it and the pose


def spawn(world, pose, change=lambda text: text):
    text = change((DATA / 'robots' / 'hog.urdf').read_text(encoding='utf-8'))
    return world.spawn(load_urdf(text, 'hbot')[0], 'hbot', pose)


def angle_between(one, other):
    w = multiply(conjugate(one.orientation), other.orientation)[3]
    return 2.0 * math.acos(min(1.0, abs(w)))


def test_link_follows_as_recorded_without_gravity_and_overshoot(world):
    model = spawn(world, Pose((0.0, 0.0, 0.5)))
    plugin = model.plugin('hog')
    world.run(1000)
    assert plugin.due == NEVER
    assert model.pose.position == (0.0, 0.0, 0.5)
    plugin.follow(GOAL)
    (first, *_), *_ = states = load('model_plugins')['hand_of_god']
    for stamp, position, velocity in states:
        world.run(1000 + AFTER + round(1000 * (stamp - first)) - world.clock.steps)
        pose, twist = model.state()
        assert pose.position == pytest.approx(position, abs=2e-4)
        assert twist.linear == pytest.approx(velocity, abs=LATE)
        assert pose.position[0] <= 1.0


def test_pose_is_output_in_each_step_while_it_follows(world):
    plugin = spawn(world, Pose()).plugin('hog')
    readings = collect(plugin.actual)
    world.run(10)
    assert not readings
    plugin.follow(GOAL)
    world.run(10)
    assert len(readings) == 10
    assert {reading[:2] for reading in readings} == {('world', 'hog_actual')}
    assert readings[-1].pose == plugin.model.pose


@pytest.mark.parametrize(
    'turn', [(0.0, 0.0, 1.0), (0.5, -0.4, 2.0), (0.0, 3.0, 0.0), (0.0, 0.0, -3.1)]
)
def test_link_rotates_the_shorter_way_and_comes_to_rest(world, turn):
    model = spawn(world, Pose((0.0, 0.0, 0.5)))
    goal = Pose((0.0, 0.0, 0.5), from_rpy(*turn))
    model.plugin('hog').follow(goal)
    left = [angle_between(model.pose, goal)]
    for _ in range(100):
        world.run(20)
        left.append(angle_between(model.pose, goal))
    assert all(after <= before + 1e-3 for before, after in itertools.pairwise(left))
    assert left[-1] < 0.01


@pytest.mark.parametrize(('mass', 'inertia'), [(0.01, 1e-6), (0.1, 1e-5), (1e-3, 1e-7)])
def test_light_link_is_stable(world, caplog, mass, inertia):
    model = spawn(
        world,
        Pose(),
        lambda text: (
            text.replace('mass value="5"', f'mass value="{mass}"')
            .replace('ixx="0.0542"', f'ixx="{inertia}"')
            .replace('iyy="0.0833"', f'iyy="{inertia}"')
            .replace('izz="0.1042"', f'izz="{inertia}"')
        ),
    )
    caplog.set_level(logging.ERROR)
    goal = Pose((1.0, 0.0, 1.0), from_rpy(0.5, 0.0, 1.0))
    model.plugin('hog').follow(goal)
    world.run(5000)
    assert math.dist(model.pose.position, goal.position) < 0.01
    assert angle_between(model.pose, goal) < 0.05
    assert not caplog.messages


def test_reduced_link_itself_follows(world):
    model = spawn(
        world, Pose(), lambda text: text.replace('<linkName>base_footprint', '<linkName>base_link')
    )
    plugin = model.plugin('hog')
    readings = collect(plugin.actual)
    plugin.follow(GOAL)
    world.run(5000)
    assert readings[-1].pose.position == pytest.approx(GOAL.position, abs=1e-4)
    assert model.pose.position == pytest.approx((1.0, 0.0, 0.9), abs=1e-4)


def test_link_follows_after_a_reset_of_time(world):
    model = spawn(world, Pose((0.0, 0.0, 0.5)))
    model.plugin('hog').follow(GOAL)
    world.run(3000)
    world.reset_simulation()
    assert model.pose.position == (0.0, 0.0, 0.5)
    world.run(3000)
    assert model.pose.position == pytest.approx(GOAL.position, abs=1e-3)
    assert not model.link('base_footprint').spec.gravity


@pytest.mark.parametrize(
    ('old', 'new', 'sentence'),
    [
        ('<linkName>base_footprint</linkName>', '', 'missing <linkName>, cannot proceed'),
        ('<linkName>base_footprint', '<linkName>nope', 'linkName: nope does not exist'),
        ('<kl>200', '<kl>-1', '<kl> and <ka> must not be negative'),
        ('<ka>200', '<ka>much', "<ka> is 'much'; it takes a finite number"),
        ('<gazebo>', '<gazebo><static>true</static>', "link 'base_footprint' cannot move"),
    ],
)
def test_plugin_with_invalid_tags_is_left_out_with_an_error(world, caplog, old, new, sentence):
    model = spawn(world, Pose(), lambda text: text.replace(old, new))
    assert f'hand_of_god: {sentence}' in caplog.text
    assert not model.plugins


def test_pose_that_is_not_finite_is_rejected(world):
    with pytest.raises(ValueError, match='follows finite numbers'):
        spawn(world, Pose()).plugin('hog').follow(compose(GOAL, Pose((math.inf, 0.0, 0.0))))
