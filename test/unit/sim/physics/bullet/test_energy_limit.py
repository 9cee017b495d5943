"""The energy of a body of two links: as mechanics gives it, and limited to what work was done."""

import math

import numpy as np
import pytest
from support.fast_body import (
    BASE,
    BODY,
    DT,
    GRAVITY,
    GROUND,
    JOINT,
    LINK,
    OTHER,
    POSES,
    SINGLE,
    TWISTS,
    drift_of,
    energies_of,
    masses,
    noted,
    watched,
)

from rosbots_description.sim.core.arrays import rotation_matrix
from rosbots_description.sim.physics.bullet.body import Masses


def test_energies_are_those_of_mechanics_half_a_step_ago(bullet, bodies):
    total, own = energies_of(TWISTS)
    peak, limit, noted_total, is_airborne = noted(bodies)
    assert noted_total == pytest.approx(total, rel=1e-12)
    assert peak == pytest.approx(own, rel=1e-12)  # without springs
    assert limit == pytest.approx(1.01 * own, rel=1e-12)  # 1 % of the greatest kinetic energy
    assert is_airborne
    assert bullet.twists == TWISTS


def test_a_spring_stores_half_of_stiffness_times_deflection_squared(bullet):
    stiffness, reference = 50.0, -0.2
    bodies = watched(masses(stiffness=stiffness, reference=reference))
    bodies.after_step()
    position, velocity, _ = JOINT
    stored = 0.5 * stiffness * (position - velocity * DT / 2.0 - reference) ** 2
    assert noted(bodies)[2] == pytest.approx(energies_of(TWISTS)[0] + stored, rel=1e-12)
    assert noted(bodies)[0] == pytest.approx(energies_of(TWISTS)[1], rel=1e-12)


def test_energy_about_a_fixed_base_counts_height_and_all_of_its_velocity(bullet):
    arm = Masses((BASE, LINK), (0,), (0.0,), (0.0,), (0.0,), (1e-6,), (0,), True)
    bodies = watched(arm)
    bodies.after_step()
    (linear, angular), (position, turn) = TWISTS[0], POSES[0]
    turning = rotation_matrix(turn).T @ angular
    kinetic = 0.5 * LINK.mass * np.dot(linear, linear) + 0.5 * np.dot(LINK.moments, turning**2)
    height = -LINK.mass * np.dot(GRAVITY, np.array(position) - np.array(linear) * DT / 2.0)
    peak, limit, total, is_airborne = noted(bodies)
    assert (peak, total) == pytest.approx((kinetic, kinetic + height), rel=1e-12)
    assert limit == pytest.approx(total + 0.01 * kinetic, rel=1e-12)
    assert not is_airborne


def test_links_without_gravity_have_no_energy_of_height(bullet):
    bodies = watched(masses()._replace(parts=(BASE, LINK._replace(has_weight=False))))
    bodies.after_step()
    middle = np.array(POSES[0][0]) - np.array(TWISTS[0][0]) * DT / 2.0
    assert noted(bodies)[2] == pytest.approx(
        energies_of(TWISTS)[0] + LINK.mass * np.dot(GRAVITY, middle), rel=1e-12
    )


def test_excess_energy_is_taken_from_all_velocities_about_the_centre_of_mass(bullet, bodies):
    limit = noted(bodies)[1]
    bullet.speed_up(1.1)
    before = dict(bullet.twists)
    _, own = energies_of(before)
    bodies.after_step()
    share = math.sqrt(limit / own)
    linear, angular = bullet.twists[-1]
    drift = drift_of(before)
    assert linear == pytest.approx(drift + share * (np.array(before[-1][0]) - drift))
    assert angular == pytest.approx(share * np.array(before[-1][1]))
    assert bullet.joint == pytest.approx((JOINT[0], share * JOINT[1], JOINT[2]))
    peak, new_limit, total, _ = noted(bodies)
    assert (peak, new_limit) == (pytest.approx(own), limit)
    assert total == pytest.approx(energies_of(before)[0] - (own - limit), rel=1e-12)


def test_energy_of_a_light_body_is_limited_as_well(bullet):
    bullet.speed_up(0.01)
    bodies = watched(masses())
    bodies.after_step()
    _, own = energies_of(bullet.twists)
    assert own < 1.0
    assert noted(bodies)[1] == pytest.approx(1.01 * own, rel=1e-12)
    bullet.speed_up(1.1)
    angular = np.array(bullet.twists[-1][1])
    bodies.after_step()
    assert bullet.twists[-1][1] == pytest.approx(math.sqrt(1.01) / 1.1 * angular)


def test_energy_below_the_limit_is_left(bullet, bodies):
    bullet.speed_up(1.004)  # 0.8 % of energy
    before = dict(bullet.twists)
    bodies.after_step()
    assert bullet.twists == before


def test_motors_and_dampers_change_the_limit_by_their_work(bullet):
    damping, (position, velocity, _), effort = 0.1, JOINT, 0.7
    bullet.joint = position, velocity, effort
    bodies = watched(masses(damping=damping))
    bodies.after_step()
    limit = noted(bodies)[1]
    bodies.after_step()
    assert noted(bodies)[1] - limit == pytest.approx(
        DT * velocity * (effort - damping * velocity), rel=1e-6
    )


def test_nothing_works_on_a_link_without_joints(bullet):
    bodies = watched(SINGLE)
    bodies.after_step()
    limit = noted(bodies)[1]
    bodies.after_step()
    assert noted(bodies)[1] == limit


def test_work_from_outside_renews_the_limit(bullet, bodies):
    bullet.speed_up(1.3)
    before = dict(bullet.twists)
    bodies.allow_external_work(BODY)
    bodies.after_step()
    assert bullet.twists == before
    assert noted(bodies)[1] == pytest.approx(1.01 * energies_of(before)[1], rel=1e-12)


def test_contact_with_a_moving_body_renews_the_limit_and_one_with_the_ground_does_not(bullet):
    bodies = watched(masses(), OTHER)
    bullet.touched = {GROUND}
    bodies.after_step()
    total, own = energies_of(TWISTS)
    assert noted(bodies)[1] == pytest.approx(total + 0.01 * own, rel=1e-12)
    bullet.speed_up(1.1)
    faster = dict(bullet.twists)
    bullet.touched = {GROUND, OTHER}
    bodies.after_step()
    assert bullet.twists == faster
    total, own = energies_of(faster)
    assert noted(bodies)[1] == pytest.approx(total + 0.01 * own, rel=1e-12)
    bullet.speed_up(1.1)
    bullet.touched = {GROUND}
    bodies.after_step()
    assert np.linalg.norm(bullet.twists[-1][1]) < 1.09 * np.linalg.norm(faster[-1][1])


def test_energy_lost_to_the_ground_is_not_given_back(bullet):
    bodies = watched(masses())
    bullet.touched = {GROUND}
    bodies.after_step()
    peak = noted(bodies)[0]
    bullet.speed_up(0.8)
    bodies.after_step()
    assert noted(bodies)[1] == pytest.approx(energies_of(bullet.twists)[0] + 0.01 * peak, rel=1e-12)


def test_limit_changes_between_total_and_own_energy_at_touch_down_and_take_off(bullet, bodies):
    total, own = energies_of(TWISTS)
    bullet.touched = {GROUND}
    bodies.after_step()
    assert noted(bodies)[1] == pytest.approx(total, rel=1e-12)
    bullet.touched = set()
    bodies.after_step()
    assert noted(bodies)[1] == pytest.approx(own, rel=1e-12)
    bodies.after_step()
    assert noted(bodies)[1] == pytest.approx(own, rel=1e-12)


def test_at_take_off_the_total_energy_is_limited_and_its_excess_removed(bullet):
    down, up = (0.0, 0.0, -9.8), (0.0, 0.0, 9.8)  # with the latter, own energy exceeds the total
    for gravity, factor in ((up, 1.0), (down, 1.2)):
        bullet.twists = dict(TWISTS)
        bodies = watched(masses())
        bodies.set(DT, gravity)
        bodies._update_body(BODY, masses(), 100.0)
        bullet.touched = {GROUND}
        bodies.after_step()
        limit = noted(bodies)[1]
        bullet.touched = set()
        bullet.speed_up(factor)
        total, own = energies_of(bullet.twists, gravity)
        bodies.after_step()
        excess = max(0.0, total - limit)
        assert noted(bodies)[1] == pytest.approx(own - excess, rel=1e-12)
        assert noted(bodies)[2] == pytest.approx(total - excess, rel=1e-12)
