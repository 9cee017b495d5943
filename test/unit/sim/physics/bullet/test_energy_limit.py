"""The energy of a body of two links: as mechanics gives it, and limited to what work was done."""

import itertools
import math
from types import SimpleNamespace

import numpy as np
import pytest

from rosbots_description.sim.core.arrays import rotation_matrix
from rosbots_description.sim.core.transforms import from_rpy
from rosbots_description.sim.physics.bullet import fast_rotation
from rosbots_description.sim.physics.bullet.body import Mass, Masses
from rosbots_description.sim.physics.bullet.fast_rotation import CHECK_STEPS, FastBodies

DT, GRAVITY = 0.002, (0.5, -1.0, -9.8)
BODY, CLIENT, GROUND, OTHER = 4, 2, 0, 7
BASE, LINK = Mass(-1, 3.0, (0.1, 0.2, 0.3), True), Mass(0, 2.0, (0.04, 0.05, 0.06), True)
POSES = {-1: ((1.0, 2.0, 3.0), from_rpy(0.3, -0.7, 1.1)),
         0: ((1.5, 1.0, 2.0), from_rpy(2.0, 0.4, 0.2))}
TWISTS = {-1: ((1.0, -2.0, 0.5), (7.0, 30.0, -4.0)), 0: ((-1.0, 3.0, 2.0), (5.0, -20.0, 9.0))}
JOINT = 0.4, 3.0, 0.0  # position [rad], velocity [rad/s], effort of its motor [N m]


BY_NAME = {'physicsClientId': CLIENT}


class Bullet:
    """PyBullet's state of one body with a link on a joint; each call is checked for the client.

    Attributes:
        touched: bodies that it touches.
    """

    def __init__(self):
        self.twists, self.joint, self.touched = dict(TWISTS), JOINT, set()

    def called(self):
        """Return the functions by the names that PyBullet gives them."""
        return SimpleNamespace(
            getBasePositionAndOrientation=self.pose, getBaseVelocity=self.velocity,
            getLinkStates=self.links, getJointStates=self.joints, getContactPoints=self.contacts,
            resetBaseVelocity=self.set_velocity, resetJointStatesMultiDof=self.set_joints)

    def pose(self, number, client):
        assert (number, client) == (BODY, CLIENT)
        return POSES[-1]

    def velocity(self, number, client):
        assert (number, client) == (BODY, CLIENT)
        return self.twists[-1]

    def links(self, number, indices, velocities, forward, client):
        assert (number, velocities, forward, client) == (BODY, 1, 1, CLIENT)
        return [(*POSES[one], *[None] * 4, *self.twists[one]) for one in indices]

    def joints(self, number, joints, client):
        assert (number, client) == (BODY, CLIENT)
        position, velocity, effort = self.joint
        return [(position, velocity, None, effort) for _ in joints]

    def contacts(self, number, **client):
        assert (number, client) == (BODY, BY_NAME)
        return [(0, BODY, one) for one in (BODY, *self.touched)]  # of two links of its own, too

    def set_velocity(self, number, linear, angular, **client):
        assert (number, client) == (BODY, BY_NAME)
        self.twists[-1] = linear, angular

    def set_joints(self, number, joints, positions, velocities, **client):
        assert (number, joints, client) == (BODY, (0,), BY_NAME)
        assert positions == [[self.joint[0]]]
        self.joint = self.joint[0], velocities[0][0], self.joint[2]

    def speed_up(self, factor):
        """Scale all velocities relative to the centre of mass, and those of joints."""
        drift = drift_of(self.twists)
        for index, (linear, angular) in self.twists.items():
            self.twists[index] = (tuple(drift + factor * (np.array(linear) - drift)),
                                  tuple(factor * np.array(angular)))


def drift_of(twists):
    """Return the velocity of the centre of mass [m/s]."""
    return (BASE.mass * np.array(twists[-1][0]) + LINK.mass * np.array(twists[0][0])) / (
        BASE.mass + LINK.mass)


def energies_of(twists, gravity=GRAVITY):
    """Return total energy, and the kinetic one about the centre of mass [J]: half a step ago."""
    potential, kinetic = 0.0, 0.0
    for part in (BASE, LINK):
        (position, turn), (linear, angular) = POSES[part.link], twists[part.link]
        middle = np.array(position) - np.array(linear) * DT / 2.0
        potential -= part.mass * float(np.dot(gravity, middle))
        turning = rotation_matrix(turn).T @ angular
        kinetic += 0.5 * part.mass * float(np.dot(linear, linear)) + 0.5 * sum(
            moment * rate**2 for moment, rate in zip(part.moments, turning, strict=True))
    drift = drift_of(twists)
    carried = 0.5 * (BASE.mass + LINK.mass) * float(drift @ drift)
    return potential + kinetic, kinetic - carried


def masses(stiffness=0.0, damping=0.0, reference=0.0, is_fixed=False, unbalanced=(0,)):
    return Masses((BASE, LINK), (0,), (damping,), (stiffness,), (reference,), (1e-6,), unbalanced,
                  is_fixed)


SINGLE = Masses((Mass(-1, 1.0, (0.1, 0.2, 0.3), True),), (), (), (), (), (), (), False)


@pytest.fixture
def bullet(monkeypatch):
    made = Bullet()
    monkeypatch.setattr(fast_rotation, 'pybullet', made.called())
    return made


def watched(of, *others):
    """Return the fast bodies of a world in which that body is one; it is found to be fast."""
    bodies = FastBodies(CLIENT)
    bodies.set(DT, GRAVITY)
    bodies.add({BODY: of, **dict.fromkeys(others, Masses((), (), (), (), (), (), (), False))})
    bodies._update_body(BODY, of, 100.0)
    return bodies


def noted(bodies):
    """Return peak of the kinetic energy, limit and total energy [J] of the body, and its flight."""
    peak, limit, is_airborne, total, _ = bodies.save_state()[1][BODY]
    return peak, limit, total, is_airborne


def test_energies_are_those_of_mechanics_half_a_step_ago(bullet):
    bodies = watched(masses())
    bodies.after_step()
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
        energies_of(TWISTS)[0] + LINK.mass * np.dot(GRAVITY, middle), rel=1e-12)


def test_energy_above_the_limit_is_taken_from_all_velocities_about_the_centre_of_mass(bullet):
    bodies = watched(masses())
    bodies.after_step()
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


def test_energy_below_the_limit_is_left(bullet):
    bodies = watched(masses())
    bodies.after_step()
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
        DT * velocity * (effort - damping * velocity), rel=1e-6)


def test_nothing_works_on_a_link_without_joints(bullet):
    bodies = watched(SINGLE)
    bodies.after_step()
    limit = noted(bodies)[1]
    bodies.after_step()
    assert noted(bodies)[1] == limit


def test_work_from_outside_renews_the_limit(bullet):
    bodies = watched(masses())
    bodies.after_step()
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


def test_limit_changes_between_total_and_own_energy_at_touch_down_and_take_off(bullet):
    bodies = watched(masses())
    bodies.after_step()
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
        bullet, touched, threshold, axis):
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


def test_a_flying_body_is_corrected_however_slow_it_is(bullet):
    bodies = watched(masses())
    bodies.after_step()
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


def test_setting_a_velocity_checks_all_bodies_before_the_next_step(bullet):
    bodies = watched(masses())
    bodies.after_step()
    bodies.until_check = 13
    bodies.allow_external_work(BODY)
    assert bodies.until_check == 13
    bodies.set_in_motion(BODY)
    assert bodies.until_check == 0
    assert noted(bodies)[1] is None


@pytest.mark.parametrize(('change', 'is_later'), [
    (lambda bodies: bodies.set(DT, GRAVITY), False), (lambda bodies: bodies.clear(), False),
    (lambda bodies: bodies.add({BODY: masses()}), True),
    (lambda bodies: bodies.remove([BODY]), True)])
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
    bodies.update()


def test_a_state_continues_as_the_original(bullet):
    bodies = watched(masses())
    bodies.after_step()
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


def test_vectors_are_turned_back_into_the_frame_of_each_link():
    random = np.random.default_rng(4)
    turns = random.normal(size=(20, 4))
    turns /= np.linalg.norm(turns, axis=1)[:, None]
    vectors = random.normal(size=(20, 3))
    expected = [rotation_matrix(tuple(turn)).T @ vector
                for turn, vector in zip(turns, vectors, strict=True)]
    assert np.allclose(fast_rotation._rotated_back(turns, vectors), expected, atol=1e-12)
    pairs = list(itertools.pairwise(vectors))
    assert (fast_rotation._cross(vectors[:-1], vectors[1:])
            == [np.cross(one, other) for one, other in pairs]).all()
