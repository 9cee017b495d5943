"""Restitution, stiffness and damping of contacts."""

import math

import pytest

from rosbots_description.sim.description import FIXED, REVOLUTE, Inertial, JointSpec, LinkSpec
from rosbots_description.sim.description.model_spec import Surface
from rosbots_description.sim.physics.bullet.contact_stiffness import (
    compliant,
    contact_spring,
    is_rigid,
    jointed_mass,
    overlap_share,
    parting_rate,
    restitution,
)
from rosbots_description.sim.physics.bullet.generated_urdf import Tree

TURN, WELD = JointSpec('j', REVOLUTE, 'a', 'b'), JointSpec('j', FIXED, 'a', 'b')
LINKS = [
    LinkSpec('a', inertial=Inertial(2.0)),
    LinkSpec('b', inertial=Inertial(3.0)),
    LinkSpec('c'),
]
BOUNCING = {'max_vel': 10.0, 'threshold': 0.1}


@pytest.mark.parametrize(
    ('surface', 'expected'),
    [
        ({'restitution': 0.64}, 0.0),  # limited by the default max_vel
        ({'restitution': 0.64, 'max_vel': 10.0}, 0.0),  # and by the default threshold
        ({'restitution': 0.64, **BOUNCING}, 0.8),
        ({'restitution': 0.64, **BOUNCING, 'max_vel': 1.0}, 0.8),
        ({'restitution': 0.64, **BOUNCING, 'max_vel': 0.99}, 0.0),
        ({'restitution': 0.64, **BOUNCING, 'threshold': 100.0}, 0.8),
        ({'restitution': 0.64, **BOUNCING, 'threshold': 101.0}, 0.0),
        ({'restitution': 9.0, **BOUNCING}, 1.0),
    ],
)
def test_restitution_of_equal_surfaces_is_theirs(surface, expected):
    assert restitution(Surface(**surface)) == pytest.approx(expected)


@pytest.mark.parametrize(
    ('step_size', 'rate', 'share'),
    [
        (0.001, 10.0, 0.01),
        (0.002, 10.0, 0.02),
        (0.01, 10.0, 0.1),
        (0.05, 10.0, 0.2),  # at most that
    ],
)
def test_share_of_a_penetration_corrected_in_a_step(step_size, rate, share):
    assert overlap_share(step_size, rate) == pytest.approx(share)


@pytest.mark.parametrize(
    ('reach', 'rate'),
    [
        (0.01, 10.0),
        (0.1, 10.0),
        (0.5, 2.0),
        (2.0, 0.5),
        (0.0, 10.0),
    ],
)
def test_overlapping_bodies_part_at_1_m_per_s_at_most(reach, rate):
    assert parting_rate(reach, 10.0) == pytest.approx(rate)
    assert parting_rate(0.0, math.inf) == pytest.approx(1.0 / 5e-6)


@pytest.mark.parametrize(
    ('joints', 'fixed_base', 'mass'),
    [
        ([None, TURN, WELD], False, 5.0),  # a link without mass adds none
        ([None, WELD, WELD], False, 0.0),
        ([None, TURN, WELD], True, 0.0),
    ],
)
def test_mass_counts_of_trees_that_move_in_themselves(joints, fixed_base, mass):
    assert jointed_mass(Tree(LINKS, joints, fixed_base)) == mass


@pytest.mark.parametrize(
    ('kp', 'mass', 'expected'),
    [
        (1e12, 2.0, 2.0 * 9.8 / 0.001),  # sinks by 1 mm under its weight
        (1e12, 1e-5, 0.098),
        (1e4, 2.0, 1e4),
        (19600.0, 2.0, 19600.0),
        (1e12, 0.0, 1e12),
    ],
)
def test_stiffness_is_limited_by_the_weight(kp, mass, expected):
    assert compliant(Surface(kp=kp, kd=3.0), mass) == Surface(kp=pytest.approx(expected), kd=3.0)


def test_default_stiffness_counts_as_rigid():
    assert is_rigid(Surface())
    assert not is_rigid(Surface(kp=9.9e11))


@pytest.mark.parametrize(('kd', 'damping'), [(1.0, 990.0), (5000.0, 5000.0)])
def test_damping_keeps_bodies_from_separating_too_fast(kd, damping):
    # Implicit: a penetration x shrinks at x k / (k dt + d), which is to be 10 x at most.
    kp, kd = contact_spring(Surface(kp=1e4, kd=kd), 0.001, 10.0)
    assert (kp, kd) == (1e4, pytest.approx(damping))
