"""How much friction is left to a tyre that slips."""

import pytest

from rosbots_description.sim.physics.bullet.friction_slip_compliance import (
    MIN_SCALE,
    TyreContact,
    slip_scales,
)

AXLE = (0.0, 1.0, 0.0)
LOAD, LIMIT = 10.0, 8.0  # [N]
STEP = 0.001  # [s]


def touch(force=(0.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0), load=LOAD):
    return TyreContact((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), load, force, velocity, LIMIT)


def held(*contacts, slips=(0.01, 0.0)):
    return slip_scales(contacts, AXLE, slips, STEP, lambda _: 1.0)


def test_a_tyre_in_the_air_is_left_alone():
    assert held() is None
    assert held(touch(load=0.0)) is None


def test_friction_that_is_left_is_the_force_that_belongs_to_the_slip():
    lateral, _ = held(touch(force=(0.0, -4.0, 0.0), velocity=(0.0, 0.04, 0.0)))
    assert lateral == pytest.approx(4.0 / LIMIT)  # v = s F already


def test_a_tyre_that_holds_without_slip_lets_go_and_one_that_slides_too_fast_is_held():
    assert held(touch(force=(0.0, -4.0, 0.0)))[0] < 4.0 / LIMIT
    assert held(touch(force=(0.0, -4.0, 0.0), velocity=(0.0, 0.06, 0.0)))[0] > 4.0 / LIMIT


def test_friction_is_never_more_than_there_is_nor_nothing():
    assert held(touch(velocity=(0.0, 100.0, 0.0)))[0] == 1.0
    assert held(touch())[0] == MIN_SCALE


def test_without_compliance_all_of_the_friction_is_held():
    _, ahead = held(touch(force=(4.0, 0.0, 0.0), velocity=(-0.5, 0.0, 0.0)))
    assert ahead == 1.0
