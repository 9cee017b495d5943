"""Which bodies count as fast, from when to when."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from support.fast_body import (
    BODY,
    CLIENT,
    DT,
    GRAVITY,
    GROUND,
    POSES,
    SINGLE,
    masses,
    noted,
    watched,
)

from rosbots_description.sim.core.arrays import rotation_matrix
from rosbots_description.sim.physics.bullet import fast_rotation
from rosbots_description.sim.physics.bullet.fast_rotation import CHECK_STEPS, FastBodies


def is_corrected(bullet, of, angular, joint_speed=0.0):
    """Tell whether a body that turns like that is found to be fast, 1 ms steps."""
    bullet.twists[-1] = (0.0, 0.0, 0.0), angular
    bullet.joint = 0.0, joint_speed, 0.0
    bodies = FastBodies(CLIENT)
    bodies.add({BODY: of})
    bodies.update()
    return bool(bodies)


@pytest.mark.parametrize(('touched', 'threshold'), [((), 0.01), ((GROUND,), 0.1)])
@pytest.mark.parametrize('axis', [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)])
def test_articulated_bodies_are_corrected_above_dt_times_rate_squared(
    bullet, touched, threshold, axis
):
    bullet.touched = set(touched)
    rate = math.sqrt(threshold / 0.001)
    for factor, expected in ((0.99, False), (1.01, True)):
        angular = tuple(factor * rate * x for x in axis)
        assert is_corrected(bullet, masses(), angular) == expected
        assert is_corrected(bullet, masses(), (0.0, 0.0, 0.0), factor * rate) == expected
    half = tuple(rate * math.sqrt(0.51) * x for x in axis)  # the speeds of joints are added
    assert is_corrected(bullet, masses(), half, rate * math.sqrt(0.51))
    assert not is_corrected(bullet, masses(), half, rate * math.sqrt(0.47))
    assert not is_corrected(bullet, masses(unbalanced=()), half, rate)  # wheels do not count


@pytest.mark.parametrize(('touched', 'threshold'), [((), 2e-4), ((GROUND,), 2e-3)])
def test_single_links_are_corrected_above_a_relative_gain_per_second(bullet, touched, threshold):
    bullet.touched = set(touched)
    direction = np.array((0.05, 0.0, math.sqrt(1.0 - 0.05**2)))  # along the principal axes
    unit = fast_rotation.energy_growth_rate(SINGLE.parts[0].moments, tuple(direction), 0.001)
    rate = math.sqrt(threshold / unit)
    for factor, expected in ((0.99, False), (1.01, True)):
        angular = tuple(rotation_matrix(POSES[-1][1]) @ (factor * rate * direction))
        assert is_corrected(bullet, SINGLE, angular) == expected


def test_a_single_link_that_gains_no_energy_is_not_corrected(bullet):
    for share in (1.5, 100.0):  # of dt w^2 = 0.01 / s, about a principal axis
        axis = rotation_matrix(POSES[-1][1])[:, 1]
        assert not is_corrected(bullet, SINGLE, tuple(axis * math.sqrt(share * 10.0)))


def test_correction_ends_after_two_seconds_of_slow_motion_on_the_ground(bullet):
    bodies = watched(masses())
    bullet.touched = {GROUND}
    bullet.twists[-1] = (0.0, 0.0, 0.0), (0.0, 0.0, 0.1)
    bullet.joint = 0.0, 0.0, 0.0
    bodies.after_step()
    checks = 0
    while bodies and checks < 1000:
        bodies.update()
        assert bodies.until_check == CHECK_STEPS
        checks += 1
    assert checks == 101  # 2.02 s at 1 ms


def test_a_flying_body_is_corrected_however_slow_it_is(bullet, bodies):
    bullet.twists[-1] = (0.0, 0.0, 0.0), (0.0, 0.0, 0.1)
    bullet.joint = 0.0, 0.0, 0.0
    for _ in range(150):
        bodies.update()
    assert bodies


def test_a_fast_check_begins_the_wait_anew(bullet):
    bodies = watched(masses())
    bullet.touched = {GROUND}
    bodies.after_step()
    for fast in [*[0.1] * 100, 1.1, *[0.1] * 100]:
        bodies._update_body(BODY, masses(), fast)
    assert bodies
    bodies._update_body(BODY, masses(), 0.1)
    assert not bodies


def test_setting_a_velocity_checks_all_bodies_before_the_next_step(bodies):
    bodies.until_check = 13
    bodies.allow_external_work(BODY)
    assert bodies.until_check == 13
    bodies.set_in_motion(BODY)
    assert bodies.until_check == 0
    assert noted(bodies)[1] is None


@pytest.mark.parametrize(
    ('change', 'is_later'),
    [
        (lambda bodies: bodies.set(DT, GRAVITY), False),
        (lambda bodies: bodies.clear(), False),
        (lambda bodies: bodies.add({BODY: masses()}), True),
        (lambda bodies: bodies.remove([BODY]), True),
    ],
)
def test_limits_are_dropped_with_what_they_were_measured_with(bullet, change, is_later):
    bodies = watched(masses())
    assert bodies.until_check == 0
    bodies.until_check = 13
    change(bodies)
    assert not bodies
    assert bodies.until_check == (13 if is_later else 0)


def test_removed_bodies_are_not_looked_at(monkeypatch):
    bodies = watched(masses())
    bodies.remove([BODY])
    monkeypatch.setattr(fast_rotation, 'pybullet', SimpleNamespace(getBaseVelocity=None))
    bodies.update()  # it would call None
    assert not bodies


def test_a_state_continues_as_the_original(bullet, bodies):
    bodies.until_check = 5
    saved = bodies.save_state()
    bullet.speed_up(1.1)
    before = dict(bullet.twists), bullet.joint
    bodies.after_step()
    first = bullet.twists[-1]
    bodies.clear()
    bodies.add({BODY: masses()})
    bullet.twists, bullet.joint = before
    bodies.restore_state(saved)
    assert bodies.until_check == 5
    bodies.after_step()
    assert bullet.twists[-1] == first
