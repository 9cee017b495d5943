"""How the shapes of links are grouped by surface, and what stands for a wheel."""

import math
from dataclasses import replace

import pytest

from rosbots_description.sim.core.transforms import NO_ROTATION, Pose, from_rpy
from rosbots_description.sim.description.model_spec import (
    FIXED,
    REVOLUTE,
    Box,
    Collision,
    Cylinder,
    JointSpec,
    LinkSpec,
    Surface,
)
from rosbots_description.sim.physics.bullet.body import Body, FrictionAxes, Place
from rosbots_description.sim.physics.bullet.friction_axes import (
    EVENLY,
    can_slip,
    friction_scales,
)
from rosbots_description.sim.physics.bullet.surfaces import crowned, rolling_arm

TYRE = Collision('tyre', Cylinder(0.1, 0.05))
AXLE = JointSpec('axle', REVOLUTE, 'base', 'wheel')


def wheel(tilt=0.0):
    """Return a wheel's link; its axle is along y but for this tilt [rad]."""
    return LinkSpec('wheel', Pose((0.0, 0.2, 0.1), from_rpy(math.pi / 2.0 + tilt, 0.0, 0.0)))


@pytest.mark.parametrize('tilt', [0.0, 5e-5, -5e-5])
def test_a_level_wheel_touches_in_its_middle_and_at_both_ends(tilt):
    *crests, lower = crowned(TYRE, wheel(tilt), AXLE)
    assert [crest.pose.position[2] for crest in crests] == pytest.approx([-0.024, 0.0, 0.024])
    assert {crest.geometry for crest in crests} == {Cylinder(TYRE.geometry.radius, 0.002)}
    shoulders = lower.geometry
    assert 0.095 < shoulders.radius < 0.099
    assert shoulders.length == TYRE.geometry.length


@pytest.mark.parametrize(('collision', 'link', 'joint'), [
    (TYRE, wheel(0.0008), AXLE),  # it touches with one side
    (TYRE, wheel(), None),
    (TYRE, wheel(), replace(AXLE, type=FIXED)),
    (TYRE, wheel(), replace(AXLE, axis=(1.0, 0.0, 0.0))),  # it tumbles
    (TYRE, LinkSpec('turntable'), AXLE),  # it lies on its face
    (Collision('box', Box((1.0, 1.0, 1.0))), wheel(), AXLE),
])
def test_what_is_no_level_wheel_stays_as_it_is(collision, link, joint):
    assert crowned(collision, link, joint) == (collision,)


@pytest.mark.parametrize('length', [1e-6, 100.0])
def test_a_crown_has_a_size_whatever_the_wheels(length):
    for shape in crowned(Collision('odd', Cylinder(0.1, length)), wheel(), AXLE):
        assert 0.05 <= shape.geometry.radius <= 0.1
        assert 0.0 < shape.geometry.length <= length


@pytest.mark.parametrize(('joint', 'arm'), [(None, 5e-4), (AXLE, 0.0)])
def test_a_loose_cylinder_resists_rolling_and_a_wheel_does_not(joint, arm):
    assert rolling_arm([TYRE], joint) == pytest.approx(arm)


def scales(link=None, turn=NO_ROTATION, friction=1.0, **surface):
    link = link or LinkSpec('l')
    collision = Collision('c', Box((1, 1, 1)), surface=Surface(**surface))
    return friction_scales(collision, link, turn, friction)


@pytest.mark.parametrize(('surface', 'expected'), [
    ({'mu': 0.4, 'mu2': 0.4, 'fdir1': (1.0, 0.0, 0.0)}, EVENLY),
    ({'mu': 100.0, 'mu2': 50.0}, EVENLY),  # as the ground's: the other of a pair has the lesser one
    ({'mu': 0.5, 'mu2': 0.1}, (0.2, 1.0, 0.2)),
    ({'mu': 0.1, 'mu2': 0.5}, (1.0, 0.2, 1.0)),
    ({'mu': 5.0, 'mu2': 0.5}, (0.5, 1.0, 0.5)),
    ({'mu': 5.0, 'mu2': 0.5, 'friction': 5.0}, (0.1, 1.0, 0.1)),
    ({'mu': 0.5, 'mu2': 0.1, 'fdir1': (0.0, 0.0, 3.0)}, (0.2, 0.2, 1.0)),
    ({'mu': 0.5, 'mu2': 0.1, 'fdir1': (1.0, 1.0, 0.0)}, EVENLY),  # none of its axes
])
def test_friction_is_weaker_along_the_direction_of_the_lesser_mu(surface, expected):
    assert scales(**surface) == pytest.approx(expected)


def test_without_a_direction_the_first_mu_acts_along_the_models_y_axis():
    side = LinkSpec('wheel', Pose((0.0, 0.0, 0.0), from_rpy(-math.pi / 2.0, 0.0, 0.0)))
    assert scales(side, mu=0.5, mu2=0.1) == pytest.approx((0.2, 0.2, 1.0))
    turned = from_rpy(0.0, 0.0, math.pi / 2.0)  # the part's y axis is the link's -x
    assert scales(turn=turned, mu=0.5, mu2=0.1) == pytest.approx((1.0, 0.2, 0.2))


@pytest.mark.parametrize(('turns', 'can'), [((0.0, math.pi / 2), True), ((0.0, 0.3), False)])
def test_a_link_slips_along_what_is_an_axis_of_all_its_parts(turns, can):
    body, places = Body(0), [Place(0, index) for index in range(len(turns))]
    body.surfaces = {'wheel': places}
    body.friction_axes = {place: FrictionAxes(from_rpy(turn, 0.0, 0.0), EVENLY)
                          for place, turn in zip(places, turns, strict=True)}
    assert can_slip(body, 'wheel', (0.0, 1.0, 0.0)) == can
