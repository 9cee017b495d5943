"""How a free rigid body turns in a step, beside what theory says."""

import math

import pytest

from rosbots_description.sim.gyration import lost_share, missing_torque

MOMENTS = (0.1, 0.2, 0.3)


def test_what_turns_about_a_principal_axis_needs_nothing():
    assert missing_torque(MOMENTS, (0.0, 50.0, 0.0), 1e-3) == (0.0, 0.0, 0.0)
    assert lost_share(MOMENTS, (0.0, 50.0, 0.0), 1e-3) == 0.0


def test_a_ball_needs_nothing():
    assert missing_torque((0.2, 0.2, 0.2), (3.0, 4.0, 5.0), 1e-3) == pytest.approx((0, 0, 0))


def test_the_share_lost_grows_with_the_square_of_the_speed_and_with_the_step():
    share = lost_share(MOMENTS, (3.0, 4.0, 5.0), 1e-3)
    assert lost_share(MOMENTS, (6.0, 8.0, 10.0), 1e-3) == pytest.approx(4.0 * share)
    assert lost_share(MOMENTS, (3.0, 4.0, 5.0), 2e-3) == pytest.approx(2.0 * share)


@pytest.mark.parametrize('step_size', [1e-4, 1e-3])
def test_the_torque_gives_back_what_the_step_loses(step_size):
    velocity = (3.0, 4.0, 5.0)
    power = sum(t * w for t, w in zip(missing_torque(MOMENTS, velocity, step_size), velocity,
                                      strict=True))
    energy = 0.5 * sum(i * w * w for i, w in zip(MOMENTS, velocity, strict=True))
    assert power == pytest.approx(energy * lost_share(MOMENTS, velocity, step_size), rel=0.02)


def test_nothing_is_given_to_what_turns_too_far_in_a_step():
    assert missing_torque(MOMENTS, (1e5, 2e5, 1e5), 1e-3) is None


def test_a_body_that_cannot_turn_loses_nothing():
    assert lost_share((0.0, 1.0, 1.0), (1.0, 2.0, 3.0), 1e-3) == 0.0
    assert not math.isnan(lost_share(MOMENTS, (0.0, 0.0, 0.0), 1e-3))
