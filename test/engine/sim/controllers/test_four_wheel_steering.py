"""A car that steers four wheels."""

import math

import pytest
from support.cars import BASE, RADIUS, SIDES, TRACK, car
from support.controllers import refused, start_controller

from rosbots_description.sim import yaw_of

ALL = tuple(name for name, _, _ in SIDES)
TYPE = 'four_wheel_steering_controller/FourWheelSteeringController'
PARAMETERS = {
    'front_wheel': ['front_left_joint', 'front_right_joint'],
    'rear_wheel': ['rear_left_joint', 'rear_right_joint'],
    'front_steering': ['front_left_steer', 'front_right_steer'],
    'rear_steering': ['rear_left_steer', 'rear_right_steer'],
    'cmd_vel_timeout': 60.0,
    'pose_covariance_diagonal': [1.0] * 6,
    'twist_covariance_diagonal': [1.0] * 6,
}
SPEED = 0.2


def spawned(world, parameters=PARAMETERS):
    """Return a car at rest and its running controller."""
    bot = world.spawn(car(steered=ALL, driven=ALL), name='car', z=RADIUS)
    drive = start_controller(bot, 'drive', TYPE, parameters)
    world.run(300)
    return bot, drive


def test_sizes_are_read_from_the_description(world):
    _, drive = spawned(world)
    assert (drive.track, drive.wheel_base, drive.radius) == pytest.approx((TRACK, BASE, RADIUS))


def test_a_car_drives_the_commanded_arc_and_its_odometry_agrees(world):
    bot, drive = spawned(world)
    drive.command(SPEED, 0.4)
    world.run(500)
    before, turned = yaw_of(bot.pose.orientation), drive.planar.heading
    world.run(2000)
    true = yaw_of(bot.pose.orientation) - before
    assert true == pytest.approx(0.8, rel=0.03)
    assert drive.planar.heading - turned == pytest.approx(true, rel=0.03)
    left, right = (bot.joint(f'front_{side}_steer').position for side in ('left', 'right'))
    assert left > right > 0.0
    assert bot.joint('rear_left_steer').position == pytest.approx(-left, abs=1e-3)


def test_a_car_goes_sideways_with_equal_angles(world):
    bot, drive = spawned(world)
    readings = []
    drive.outputs['steering'].connect(readings.append)
    drive.steer(SPEED, 0.5, 0.5)
    world.run(500)
    x, y, _ = bot.pose.position
    world.run(1000)
    gone = bot.pose.position[0] - x, bot.pose.position[1] - y
    assert math.atan2(gone[1], gone[0]) == pytest.approx(0.5, abs=0.03)
    assert abs(yaw_of(bot.pose.orientation)) < 0.03
    assert drive.planar.velocity[:2] == pytest.approx(
        (SPEED * math.cos(0.5), SPEED * math.sin(0.5)), abs=0.01
    )
    assert readings[-1][1:] == pytest.approx((0.5, 0.5), abs=1e-3)
    drive.command(SPEED, 0.0)
    world.run(300)
    assert bot.joint('front_left_steer').position == pytest.approx(0.0, abs=1e-3)


def test_a_command_expires(world):
    bot, drive = spawned(world, PARAMETERS | {'cmd_vel_timeout': 0.1})
    drive.steer(SPEED, 0.5, -0.5)
    world.run(300)
    assert bot.joint('front_left_joint').velocity == pytest.approx(0.0, abs=0.05)
    assert bot.joint('front_left_steer').position == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize(
    ('change', 'text'),
    [
        ({'front_wheel': None}, "Couldn't retrieve wheel param 'front_wheel'."),
        ({'front_wheel': 'front_left_joint'}, '#front wheels (1) != #rear wheels (2).'),
        (
            {'front_steering': ['a'], 'rear_steering': ['b']},
            '#two steering by axle (left and right) is needed; now : 1 .',
        ),
        (
            {'front_wheel': ['nose', 'front_right_joint']},
            "nose couldn't be retrieved from model description",
        ),
    ],
)
def test_bad_parameters_get_a_clear_answer(change, text, world):
    assert text in refused(spawned, world, PARAMETERS | change)


@pytest.mark.parametrize('bad', [(math.nan, 0.0, 0.0), (0.0, math.inf, 0.0)])
def test_what_is_not_finite_is_refused(bad, world):
    _, drive = spawned(world)
    with pytest.raises(ValueError, match='finite'):
        drive.steer(*bad)
