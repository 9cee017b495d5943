"""The article's robot falls, stands and drives as it does in the real Gazebo."""

import math
from functools import cache

import pytest
from support import SETTLED, SPAWN_POSE, empty_world, robot_spec
from support.motion import (
    COMMANDS,
    RECORDED,
    angle_between,
    drive_as_recorded,
    measure,
    ramp_delays,
)

SPEED_SHARE = 0.03  # of Gazebo's steady speed
WHEEL_SHARE = 0.015  # of the speed of Gazebo's wheels
T90_SHARE = 0.05  # of the time to 90 % of the steady speed
DISPLACEMENT_SHARE = 0.04  # of the way Gazebo's robot has gone at rest
TURN_SHARE = 0.04  # of the angle Gazebo's robot has turned at rest
RAMP_TOLERANCE = 0.015  # [s] by which a speed is reached earlier or later
REST_HEIGHT = (-0.120, 0.002)  # [m] of base_footprint: the wheels reach 0.12 m below it
IDLE_CREEP = 1e-4  # [m] in thirty seconds
TREMBLING = 1e-3  # [m/s or rad/s] of a robot at rest; in Gazebo it is 0.004 and 0.016


@cache
def samples(name):
    """Return the motion for a recorded command."""
    return drive_as_recorded(name)


@cache
def ours(name):
    """Return what gazebo_motion.json tells, for our robot."""
    return measure(samples(name), RECORDED[name]['seconds'], turns=name == 'turn')


@pytest.mark.parametrize(
    ('name', 'quantity'), [('straight', 'v'), ('turn', 'w'), ('arc', 'v'), ('arc', 'w')]
)
def test_steady_speeds_are_gazebos(name, quantity):
    assert ours(name)[quantity] == pytest.approx(RECORDED[name][quantity], rel=SPEED_SHARE)


@pytest.mark.parametrize('name', COMMANDS)
def test_full_speed_is_reached_when_gazebo_reaches_it(name):
    assert ours(name)['t90'] == pytest.approx(RECORDED[name]['t90'], rel=T90_SHARE)


@pytest.mark.parametrize('name', COMMANDS)
@pytest.mark.parametrize('side', ['left', 'right'])
def test_the_wheels_turn_as_gazebos(name, side):
    assert ours(name)[side] == pytest.approx(RECORDED[name][side], rel=WHEEL_SHARE)


@pytest.mark.parametrize('name', ['straight', 'arc'])
def test_the_robot_comes_to_rest_where_gazebos_does(name):
    x, y = RECORDED[name]['x'], RECORDED[name]['y']
    apart = math.dist((ours(name)['x'], ours(name)['y']), (x, y))
    assert apart < DISPLACEMENT_SHARE * math.hypot(x, y)


@pytest.mark.parametrize('name', ['turn', 'arc'])
def test_the_robot_comes_to_rest_at_gazebos_heading(name):
    yaw = RECORDED[name]['yaw']
    assert abs(angle_between(ours(name)['yaw'], yaw)) < TURN_SHARE * abs(yaw)


def test_a_straight_drive_veers_no_more_than_gazebos():
    assert abs(ours('straight')['yaw']) <= abs(RECORDED['straight']['yaw'])


def test_speeding_up_and_slowing_down_follow_gazebos_ramp():
    ramp, end = RECORDED['ramp'], RECORDED['straight']['seconds']
    delays = ramp_delays(samples('straight'), ramp['start'], 0.0, rising=True)
    delays += ramp_delays(samples('straight'), ramp['stop'], end, rising=False)
    assert max(map(abs, delays)) <= RAMP_TOLERANCE


def test_the_robot_stands_on_its_wheels_and_neither_creeps_nor_trembles():
    with empty_world() as world:
        model = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
        world.run(SETTLED)
        before = model.pose.position
        assert before[2] == pytest.approx(REST_HEIGHT[0], abs=REST_HEIGHT[1])
        for _ in range(30_000 // 37):
            world.run(37)  # no divisor of the plugin's period
            twist = model.twist
            assert max(map(abs, (*twist.linear, *twist.angular))) < TREMBLING
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
