"""The pose algebra, against known cases and its own inverses."""

import math

import pytest

from rosbots_description.sim.core.transforms import (
    NO_ROTATION,
    Pose,
    compose,
    from_rpy,
    inverse,
    multiply,
    normalise,
    relative,
    rotate,
    to_rpy,
    yaw_of,
)

QUARTER_LEFT = from_rpy(0.0, 0.0, math.pi / 2)


def test_a_quarter_turn_left_takes_x_to_y():
    assert rotate(QUARTER_LEFT, (1.0, 0.0, 0.0)) == pytest.approx((0.0, 1.0, 0.0))


def test_pitch_is_positive_nose_down():
    assert rotate(from_rpy(0.0, math.pi / 2, 0.0), (1.0, 0.0, 0.0)) == pytest.approx((0, 0, -1))


def test_rpy_is_about_fixed_axes_in_the_order_roll_pitch_yaw():
    by_hand = multiply(from_rpy(0, 0, 0.3), multiply(from_rpy(0, 0.2, 0), from_rpy(0.1, 0, 0)))
    assert from_rpy(0.1, 0.2, 0.3) == pytest.approx(by_hand)


@pytest.mark.parametrize('rpy', [(0.1, -0.2, 0.3), (3.0, 1.5, -3.0), (0.0, 0.0, 0.0)])
def test_rpy_survives_the_round_trip(rpy):
    assert to_rpy(from_rpy(*rpy)) == pytest.approx(rpy)


def test_pitch_of_90_degrees_gives_finite_angles():
    assert to_rpy(from_rpy(0.0, math.pi / 2, 0.0))[1] == pytest.approx(math.pi / 2)


def test_compose_expresses_the_second_pose_in_the_first():
    frame = Pose((1.0, 2.0, 3.0), QUARTER_LEFT)
    assert compose(frame, Pose((1.0, 0.0, 0.0))).position == pytest.approx((1.0, 3.0, 3.0))


def test_relative_undoes_compose():
    frame = Pose((1.0, 2.0, 3.0), from_rpy(0.1, 0.2, 0.3))
    pose = Pose((-4.0, 5.0, 6.0), from_rpy(-0.3, 0.1, 2.0))
    back = relative(compose(frame, pose), frame)
    assert back.position == pytest.approx(pose.position)
    assert back.orientation == pytest.approx(pose.orientation)


def test_inverse_undoes_a_pose():
    pose = Pose((1.0, 2.0, 3.0), from_rpy(0.1, 0.2, 0.3))
    nothing = compose(pose, inverse(pose))
    assert nothing.position == pytest.approx((0, 0, 0))
    assert nothing.orientation == pytest.approx(NO_ROTATION)


def test_zero_quaternion_is_the_identity():
    assert normalise((0.0, 0.0, 0.0, 0.0)) == NO_ROTATION
    assert normalise((0.0, 0.0, 0.0, 2.0)) == NO_ROTATION


def test_yaw_keeps_its_sign():
    assert yaw_of(from_rpy(0.0, 0.0, -0.7)) == pytest.approx(-0.7)
