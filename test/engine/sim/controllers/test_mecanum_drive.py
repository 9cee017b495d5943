"""The wheels of a mecanum drive, and the odometry that they give."""

import pytest
from support.cars import BASE, RADIUS, SIDES, TRACK, car
from support.controllers import refused, start_controller

ALL = tuple(name for name, _, _ in SIDES)
TYPE = 'mecanum_drive_controller/MecanumDriveController'
PARAMETERS = {
    'front_left_wheel_joint': 'front_left_joint',
    'back_left_wheel_joint': 'rear_left_joint',
    'back_right_wheel_joint': 'rear_right_joint',
    'front_right_wheel_joint': 'front_right_joint',
    'pose_covariance_diagonal': [1.0] * 6,
    'twist_covariance_diagonal': [1.0] * 6,
    'cmd_vel_timeout': 60.0,
}
ARM = (BASE + TRACK) / 2.0


def spawned(world, parameters=PARAMETERS):
    """Return a car on ice, as it has no rollers, and its running controller."""
    bot = world.spawn(car(steered=(), driven=ALL, mu=0.0), name='car', z=RADIUS)
    drive = start_controller(bot, 'drive', TYPE, parameters)
    world.run(100)
    return bot, drive


@pytest.mark.parametrize(
    ('x', 'y', 'turn', 'speeds'),
    [
        (0.2, 0.0, 0.0, (1.0, 1.0, 1.0, 1.0)),
        (0.0, 0.2, 0.0, (-1.0, 1.0, -1.0, 1.0)),
        (0.0, 0.0, 0.2 / ARM, (-1.0, -1.0, 1.0, 1.0)),
    ],
)
def test_wheels_turn_for_the_motion_and_odometry_follows_them(x, y, turn, speeds, world):
    _, drive = spawned(world)
    drive.command(x, turn, y)
    world.run(300)
    found = [wheel.joint.velocity * RADIUS / 0.2 for wheel in drive.wheels]
    assert found == pytest.approx(speeds, abs=0.01)
    assert drive.planar.velocity == pytest.approx((x, y, turn), abs=0.005)


def test_sizes_are_read_from_the_description(world):
    _, drive = spawned(world)
    assert (drive.radius, drive.arm) == pytest.approx((RADIUS, ARM))


def test_a_missing_wheel_is_named(world):
    sentence, *_ = refused(spawned, world, PARAMETERS | {'back_left_wheel_joint': None})
    assert sentence == "Couldn't retrieve back_left_wheel_joint from param server."
