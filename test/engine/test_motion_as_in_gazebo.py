"""The article's robot falls, stands and drives as it does in the real Gazebo."""

import json
import math
from functools import cache

import pytest
from support import ROOT, SETTLED, SPAWN_POSE, empty_world, robot_spec

from rosbots_description.sim.pose import relative, yaw_of

GAZEBO = json.loads((ROOT / 'test' / 'data' / 'gazebo_motion.json').read_text(encoding='utf-8'))
SPEED_SHARE = 0.03  # of Gazebo's steady speed
DISPLACEMENT_SHARE = 0.04  # of the way Gazebo's robot has gone at rest
TURN_TOLERANCE = 0.15  # [rad] after five seconds of turning
REST_HEIGHT = (-0.120, 0.002)  # [m] of base_footprint: the wheels reach 0.12 m below it
IDLE_CREEP = 0.002  # [m] in thirty seconds


@cache
def drive(name):
    """Return steady speeds, and displacement and turn at rest, as in gazebo_motion.json."""
    command, seconds = GAZEBO[name]['command'], GAZEBO[name]['seconds']
    with empty_world() as world:
        model = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
        world.run(SETTLED)
        start = model.pose
        model.plugins[0].command(*command)
        world.run(1000)
        speeds = []
        for _ in range((seconds - 1) * 100):
            world.run(10)
            pose, twist = model.state()
            yaw = yaw_of(pose.orientation)
            vx, vy, _ = twist.linear
            speeds.append((math.cos(yaw) * vx + math.sin(yaw) * vy, twist.angular[2]))
        model.plugins[0].command(0.0, 0.0)
        world.run(3000)
        end = relative(model.pose, start)
        v, w = (sum(values) / len(speeds) for values in zip(*speeds, strict=True))
        turned = yaw_of(end.orientation)
        turns = round((GAZEBO[name]['yaw'] - turned) / (2 * math.pi))
        return {
            'v': v,
            'w': w,
            'x': end.position[0],
            'y': end.position[1],
            'yaw': turned + turns * 2 * math.pi,
        }


@pytest.mark.parametrize(
    ('name', 'quantity'), [('straight', 'v'), ('turn', 'w'), ('arc', 'v'), ('arc', 'w')]
)
def test_steady_speeds_are_gazebos(name, quantity):
    assert drive(name)[quantity] == pytest.approx(GAZEBO[name][quantity], rel=SPEED_SHARE)


@pytest.mark.parametrize('name', ['straight', 'arc'])
def test_the_robot_comes_to_rest_where_gazebos_does(name):
    ours, theirs = drive(name), GAZEBO[name]
    apart = math.dist((ours['x'], ours['y']), (theirs['x'], theirs['y']))
    assert apart < DISPLACEMENT_SHARE * math.hypot(theirs['x'], theirs['y'])


def test_turning_on_the_spot_ends_at_gazebos_heading():
    assert drive('turn')['yaw'] == pytest.approx(GAZEBO['turn']['yaw'], abs=TURN_TOLERANCE)


def test_the_robot_stands_on_its_wheels_and_does_not_creep():
    with empty_world() as world:
        model = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
        world.run(SETTLED)
        before = model.pose.position
        assert before[2] == pytest.approx(REST_HEIGHT[0], abs=REST_HEIGHT[1])
        world.run(30_000)
        assert math.dist(before, model.pose.position) < IDLE_CREEP


def test_the_fall_takes_as_long_as_in_gazebo():
    with empty_world() as world:
        model = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
        steps = 0
        while model.pose.position[2] > REST_HEIGHT[0]:
            world.run(1)
            steps += 1
        assert steps * 0.001 == pytest.approx(0.355, abs=0.003)
        world.run(20)
        assert abs(model.twist.linear[2]) < 0.02  # it does not bounce
