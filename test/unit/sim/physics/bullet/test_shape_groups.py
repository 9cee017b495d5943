"""Contact shapes of a wheel."""

import math
from dataclasses import replace

import pytest

from rosbots_description.sim.core.transforms import Pose, from_rpy
from rosbots_description.sim.description.model_spec import (
    FIXED,
    REVOLUTE,
    Box,
    Collision,
    Cylinder,
    JointSpec,
    LinkSpec,
    Plane,
)
from rosbots_description.sim.physics.bullet.generated_urdf import Tree
from rosbots_description.sim.physics.bullet.shape_groups import crowned, is_floor, touching_end

TYRE = Collision('tyre', Cylinder(0.1, 0.05))
AXLE = JointSpec('axle', REVOLUTE, 'base', 'wheel')


def wheel(tilt=0.0):
    """Return the link of a wheel with its axle along y, tilted by `tilt` [rad]."""
    return LinkSpec('wheel', Pose((0.0, 0.2, 0.1), from_rpy(math.pi / 2.0 + tilt, 0.0, 0.0)))


LEVEL = 5e-6 / TYRE.geometry.length  # [rad] at which one end is 5 um lower


@pytest.mark.parametrize('tilt', [0.0, 0.99 * LEVEL, -0.99 * LEVEL])
def test_level_wheel_has_crests_in_the_middle_and_at_both_ends(tilt):
    *crests, lower = crowned(TYRE, wheel(tilt), AXLE)
    assert [crest.pose.position for crest in crests] == [
        pytest.approx((0.0, 0.0, z)) for z in (-0.024, 0.0, 0.024)
    ]
    assert {crest.geometry for crest in crests} == {Cylinder(TYRE.geometry.radius, 0.002)}
    shoulders = lower.geometry
    assert 0.095 < shoulders.radius < 0.099
    assert shoulders.length == TYRE.geometry.length


@pytest.mark.parametrize(
    ('collision', 'link', 'joint'),
    [
        (TYRE, wheel(1.01 * LEVEL), AXLE),  # tilted: one edge touches
        (TYRE, wheel(-1.01 * LEVEL), AXLE),
        (TYRE, wheel(), None),
        (TYRE, wheel(), replace(AXLE, type=FIXED)),
        # the axis is not that of the cylinder
        (
            TYRE,
            wheel(),
            replace(AXLE, axis=(1.0, 0.0, 0.0)),
        ),
        (TYRE, LinkSpec('turntable'), AXLE),  # a turntable
        (Collision('box', Box((1.0, 1.0, 1.0))), wheel(), AXLE),
    ],
)
def test_other_shape_than_a_level_wheel_is_unchanged(collision, link, joint):
    assert crowned(collision, link, joint) == (collision,)


@pytest.mark.parametrize('length', [1e-6, 100.0])
def test_crowned_profile_has_positive_size_for_any_wheel(length):
    for shape in crowned(Collision('odd', Cylinder(0.1, length)), wheel(), AXLE):
        assert 0.05 <= shape.geometry.radius <= 0.1
        assert 0.0 < shape.geometry.length <= length


def test_wheel_as_thin_as_a_crest_has_one_in_its_middle():
    rim, lower = crowned(Collision('disc', Cylinder(0.1, 0.001)), wheel(), AXLE)
    assert rim.pose.position == (0.0, 0.0, 0.0)
    assert (rim.geometry, lower.geometry.length) == (Cylinder(0.1, 0.001), 0.001)


@pytest.mark.parametrize('length', [0.002, 0.05, 0.3, 1.0])
def test_shoulders_are_as_low_as_needed_for_no_contact_of_theirs(length):
    *_, lower = crowned(Collision('tyre', Cylinder(0.1, length)), wheel(), AXLE)
    half_diagonal = math.hypot(0.1, 0.1, length / 2.0)
    assert 0.02 < (0.1 - lower.geometry.radius) / half_diagonal < 0.025


@pytest.mark.parametrize(
    ('axis', 'end'),
    [((0.0, 1.0, 0.0), 0.0), ((0.0, 0.995, 0.1), -0.025), ((0.0, 0.995, -0.1), 0.025)],
)
def test_a_lying_cylinder_touches_the_floor_with_its_lower_end_or_all_of_its_length(axis, end):
    assert touching_end(TYRE.geometry, axis) == end


GROUND, PLATE = (Collision('c', shape) for shape in (Plane((0.0, 0.0, 1.0)), Box((1.0, 1.0, 0.1))))


@pytest.mark.parametrize(
    ('shapes', 'fixed', 'expected'),
    [
        ((GROUND,), True, True),
        ((GROUND, GROUND), True, True),
        ((GROUND,), False, False),
        ((GROUND, PLATE), True, False),
        ((PLATE,), True, False),
        ((), True, False),
    ],
)
def test_a_floor_is_fixed_and_made_of_planes_only(shapes, fixed, expected):
    assert is_floor(Tree([LinkSpec('l', collisions=shapes)], [None], fixed)) == expected
