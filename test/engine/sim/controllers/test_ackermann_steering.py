"""A car with one driven wheel and one steering joint under ackermann_steering_controller."""

import math

import pytest
from support.cars import BASE, RADIUS, car
from support.controllers import start_controller

from rosbots_description.sim import yaw_of
from rosbots_description.sim.controllers import ControllerError

TYPES = [
    'ackermann_steering_controller/AckermannSteeringController',
    'steer_drive_controller/SteerDriveController',
]
PARAMETERS = {
    'rear_wheel': 'rear_left_joint',
    'front_steer': 'front_left_steer',
    'wheel_separation_h': BASE,
    'pose_covariance_diagonal': [1.0] * 6,
    'twist_covariance_diagonal': [1.0] * 6,
}
FORWARD, ANGLE = 0.3, 0.2


def spawned(world, kind=TYPES[0], parameters=PARAMETERS):
    """Return a car at rest and its running controller."""
    bot = world.spawn(car(steered=('front_left',), driven=('rear_left',)), name='car', z=RADIUS)
    drive = start_controller(bot, 'drive', kind, parameters)
    world.run(300)
    return bot, drive


@pytest.mark.parametrize('kind', TYPES)
def test_wheel_and_steering_follow_the_command(kind, world):
    bot, drive = spawned(world, kind)
    drive.command(FORWARD, ANGLE)
    world.run(450)
    assert bot.joint('rear_left_joint').velocity == pytest.approx(FORWARD / RADIUS, rel=0.01)
    assert bot.joint('front_left_steer').position == pytest.approx(ANGLE, abs=1e-3)
    assert yaw_of(bot.pose.orientation) > 0.0
    world.run(300)
    assert bot.joint('rear_left_joint').velocity == pytest.approx(0.0, abs=0.01)
    assert bot.joint('front_left_steer').position == pytest.approx(0.0, abs=1e-3)


def test_odometry_is_that_of_a_bicycle(world):
    bot, drive = spawned(world, parameters=PARAMETERS | {'cmd_vel_timeout': 9.0})
    drive.command(FORWARD, ANGLE)
    world.run(1000)
    turned, before = drive.planar.heading, bot.joint('rear_left_joint').position
    world.run(500)
    way = (bot.joint('rear_left_joint').position - before) * RADIUS
    assert drive.planar.heading - turned == pytest.approx(way * math.tan(ANGLE) / BASE, rel=0.01)
    assert drive.planar.velocity[0] == pytest.approx(FORWARD, rel=0.01)


def test_it_claims_joints_of_two_interfaces(world):
    bot, _ = spawned(world)
    (status,) = bot.plugin('gazebo_ros_control').manager.list()
    assert status.claimed == (
        ('hardware_interface::VelocityJointInterface', ('rear_left_joint',)),
        ('hardware_interface::PositionJointInterface', ('front_left_steer',)),
    )


def test_a_steering_joint_without_position_interface_is_named(world):
    with pytest.raises(
        ControllerError,
        match="Could not find resource 'rear_right_joint' in "
        "'hardware_interface::PositionJointInterface'",
    ):
        spawned(world, parameters=PARAMETERS | {'front_steer': 'rear_right_joint'})
