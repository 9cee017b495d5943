"""Friction of a tyre with slip compliance."""

import pytest

from rosbots_description.sim.core.transforms import IDENTITY, NO_ROTATION, Twist
from rosbots_description.sim.physics.bullet.body import Body, FrictionAxes, Place
from rosbots_description.sim.physics.bullet.friction_slip import SlippingLinks
from rosbots_description.sim.physics.bullet.friction_slip_compliance import (
    MIN_SCALE,
    TyreContact,
    slip_scales,
    velocity_at,
)

AXLE = (0.0, 1.0, 0.0)
LOAD, LIMIT = 10.0, 8.0  # [N]
STEP = 0.001  # [s]


def touch(force=(0.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0), load=LOAD, limit=LIMIT):
    return TyreContact((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), load, force, velocity, limit)


def held(*contacts, slips=(0.01, 0.0)):
    return slip_scales(contacts, AXLE, slips, STEP, lambda _: 1.0)


def test_tyre_without_contact_is_unchanged():
    assert held() is None
    assert held(touch(load=0.0)) is None


def test_friction_is_the_force_of_the_slip_velocity():
    lateral, _ = held(touch(force=(0.0, -4.0, 0.0), velocity=(0.0, 0.04, 0.0)))
    assert lateral == pytest.approx(4.0 / LIMIT)  # v = s F already


def test_sticking_tyre_is_released_and_fast_sliding_tyre_is_braked():
    assert held(touch(force=(0.0, -4.0, 0.0)))[0] < 4.0 / LIMIT
    assert held(touch(force=(0.0, -4.0, 0.0), velocity=(0.0, 0.06, 0.0)))[0] > 4.0 / LIMIT


def test_friction_scale_is_between_a_minimum_and_one():
    assert held(touch(velocity=(0.0, 100.0, 0.0)))[0] == 1.0
    assert held(touch())[0] == MIN_SCALE


def test_friction_is_full_without_compliance():
    _, ahead = held(touch(force=(4.0, 0.0, 0.0), velocity=(-0.5, 0.0, 0.0)))
    assert ahead == 1.0


@pytest.mark.parametrize('axle', [AXLE, (0.0, 0.8, 0.6), (0.0, 0.6, -0.8)])  # upright or tilted
def test_friction_is_the_force_of_the_slip_by_implicit_euler(axle):
    contacts = touch(force=(4.0, -2.0, 0.0), velocity=(-0.02, 0.03, 0.0), load=4.9)
    scales = slip_scales([contacts], axle, (0.01, 0.02), STEP, lambda _: 0.5)
    gain = STEP * 9.8 / 4.9  # dt / m
    most = LIMIT * 0.5
    assert scales == pytest.approx(
        (
            abs(-2.0 * gain - 0.03) / (0.01 + gain) / most,
            abs(4.0 * gain + 0.02) / (0.02 + gain) / most,
        )
    )


def test_least_scale_is_a_thousandth():
    assert MIN_SCALE == 1e-3


def test_contacts_without_load_or_friction_do_not_count():
    touching = touch(force=(0.0, -4.0, 0.0), velocity=(0.0, 0.06, 0.0))
    for other in (
        touch(velocity=(5.0, 5.0, 0.0), load=0.0),
        touch(velocity=(5.0, 5.0, 0.0), limit=0.0),
    ):
        assert held(other) is None
        assert held(other, touching) == held(touching)


def test_velocity_is_the_mean_by_load_and_forces_and_limits_are_added():
    one = touch(force=(0.0, -1.0, 0.0), velocity=(0.0, 0.01, 0.0), load=3.0, limit=2.0)
    two = touch(force=(0.0, -3.0, 0.0), velocity=(0.0, 0.05, 0.0), load=1.0, limit=6.0)
    both = touch(force=(0.0, -4.0, 0.0), velocity=(0.0, 0.02, 0.0), load=4.0, limit=8.0)
    assert held(one, two) == pytest.approx(held(both))


def test_velocity_of_a_point_is_that_of_a_rigid_body():
    assert velocity_at(
        (1.0, 0.0, 2.0), (0.0, 0.0, 2.0), (0.1, 0.2, 0.3), (0.0, 0.0, 2.0)
    ) == pytest.approx((0.1, 2.2, 0.3))


def test_a_tyre_whose_compliance_is_set_to_zero_has_its_described_friction():
    place, body, scales = Place(1, -1), Body(0), []
    body.surfaces['tyre'] = [place]
    body.friction_axes[place] = FrictionAxes(NO_ROTATION, (1.0, 0.5, 0.7))
    links = SlippingLinks(0, lambda _, found: scales.append(found), lambda _: 1.0)
    links.update_friction(body, 'tyre', (IDENTITY, Twist()), AXLE, (0.0, 0.0), STEP)
    assert scales == [(1.0, 0.5, 0.7)]
