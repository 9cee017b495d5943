"""Robots fall, stand and drive as they do in the real Gazebo."""

import math
from functools import cache

import pytest
from support import SETTLED, SPAWN_POSE, empty_world, robot_spec
from support.motion import (
    ROBOTS,
    compare_drive,
    compare_idle,
    drive_as_recorded,
    ramp_delays,
)
from support.recorded import exceeded, load

RAMP_TOLERANCE = 0.015  # [s] by which a speed is reached earlier or later
REST_HEIGHT = (-0.120, 0.002)  # [m] of base_footprint: the wheels reach 0.12 m below it
IDLE_CREEP = 1e-4  # [m] in thirty seconds
TREMBLING = 1e-3  # [m/s or rad/s] of a robot at rest; in Gazebo it is 0.004 and 0.016
DRIVES = [(name, command) for name in ROBOTS for command in load(name)['drives']]

# What is further from Gazebo than the tolerances of support/motion.py: how far, and why.
HAIR = '5 % of the speed lie between what is left of it there and here'
TREMBLES = 'its ramps begin at the measured speed, which trembles in Gazebo'
KNOWN = (
    ('box4 arc_v0.5_w0.5', 'stop_w', 8.0, HAIR),
    ('box4 turn_w1.0', 'odom', 2.7, 'its front wheels slip by 4 mm/s'),
    ('article turn_w1.0', 'lateral', 2.1, 'it turns about a point 1.1 cm further ahead'),
    ('article turn_w1.0', 'path', 1.9, 'the same'),
    ('article turn_w1.0', 'rest place', 1.3, 'the same'),
    ('tricycle back_v-0.3_a-0.3', '', 1.6, TREMBLES),
    ('tricycle straight_v0.5', '', 1.7, TREMBLES),
    ('tricycle steer_v0.5_a0.5', 'odom', 3.6, 'speeds in the odometry frame turn with its heading'),
    ('tricycle steer_v0.5_a0.5', 'left_joint', 1.5, 'it turns by 2 % more'),
    ('tricycle steer_v0.5_a0.5', 't90', 2.7, TREMBLES),
)  # fmt: skip

samples = cache(drive_as_recorded)


@pytest.mark.parametrize(('name', 'command'), DRIVES)
def test_a_drive_is_gazebos_in_each_quantity(name, command):
    differences = compare_drive(name, command, samples=samples(name, command))
    assert exceeded(differences, KNOWN) == []


@pytest.mark.parametrize('name', ['burger', 'skid4', 'tricycle'])
def test_a_robot_that_nobody_commands_stays_where_it_is(name):
    assert exceeded(compare_idle(name), KNOWN) == []


def test_speeding_up_and_slowing_down_follow_gazebos_ramp():
    article, straight = load('article'), samples('article', 'straight_v0.5')
    ramp, end = article['ramp'], article['drives']['straight_v0.5']['seconds']
    delays = ramp_delays(straight, ramp['start'], 0.0, rising=True)
    delays += ramp_delays(straight, ramp['stop'], end, rising=False)
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
