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
)
from rosbots_description.sim.physics.bullet.shape_groups import crowned

TYRE = Collision('tyre', Cylinder(0.1, 0.05))
AXLE = JointSpec('axle', REVOLUTE, 'base', 'wheel')


def wheel(tilt=0.0):
    """Return the link of a wheel with its axle along y, tilted by `tilt` [rad]."""
    return LinkSpec('wheel', Pose((0.0, 0.2, 0.1), from_rpy(math.pi / 2.0 + tilt, 0.0, 0.0)))


@pytest.mark.parametrize('tilt', [0.0, 5e-5, -5e-5])
def test_level_wheel_has_crests_in_the_middle_and_at_both_ends(tilt):
    *crests, lower = crowned(TYRE, wheel(tilt), AXLE)
    assert [crest.pose.position[2] for crest in crests] == pytest.approx([-0.024, 0.0, 0.024])
    assert {crest.geometry for crest in crests} == {Cylinder(TYRE.geometry.radius, 0.002)}
    shoulders = lower.geometry
    assert 0.095 < shoulders.radius < 0.099
    assert shoulders.length == TYRE.geometry.length


@pytest.mark.parametrize(('collision', 'link', 'joint'), [
    (TYRE, wheel(0.0008), AXLE),  # tilted: one edge touches
    (TYRE, wheel(), None),
    (TYRE, wheel(), replace(AXLE, type=FIXED)),
    (TYRE, wheel(), replace(AXLE, axis=(1.0, 0.0, 0.0))),  # the axis is not that of the cylinder
    (TYRE, LinkSpec('turntable'), AXLE),  # a turntable
    (Collision('box', Box((1.0, 1.0, 1.0))), wheel(), AXLE),
])
def test_other_shape_than_a_level_wheel_is_unchanged(collision, link, joint):
    assert crowned(collision, link, joint) == (collision,)


@pytest.mark.parametrize('length', [1e-6, 100.0])
def test_crowned_profile_has_positive_size_for_any_wheel(length):
    for shape in crowned(Collision('odd', Cylinder(0.1, length)), wheel(), AXLE):
        assert 0.05 <= shape.geometry.radius <= 0.1
        assert 0.0 < shape.geometry.length <= length
