"""Friction scales along the axes of a surface, and axes of slip of a link."""

import math

import pytest

from rosbots_description.sim.core.transforms import NO_ROTATION, Pose, from_rpy
from rosbots_description.sim.description.model_spec import Box, Collision, LinkSpec, Surface
from rosbots_description.sim.physics.bullet.body import Body, FrictionAxes, Place
from rosbots_description.sim.physics.bullet.friction_axes import (
    can_slip,
    directions,
    first_direction,
    friction_scales,
)

ISOTROPIC = (1.0, 1.0, 1.0)
LEFT = from_rpy(0.0, 0.0, math.pi / 2.0)  # turns x onto y


def scales(link=None, turn=NO_ROTATION, friction=1.0, **surface):
    link = link or LinkSpec('l')
    collision = Collision('c', Box((1, 1, 1)), surface=Surface(**surface))
    return friction_scales(collision, link, turn, friction)


@pytest.mark.parametrize(
    ('surface', 'expected'),
    [
        ({'mu': 0.4, 'mu2': 0.4, 'fdir1': (1.0, 0.0, 0.0)}, ISOTROPIC),
        ({'mu': 100.0, 'mu2': 50.0}, ISOTROPIC),  # as the ground
        ({'mu': 0.5, 'mu2': 0.1}, (0.2, 1.0, 0.2)),
        ({'mu': 0.1, 'mu2': 0.5}, (1.0, 0.2, 1.0)),
        ({'mu': 5.0, 'mu2': 0.5}, (0.5, 1.0, 0.5)),
        ({'mu': 5.0, 'mu2': 0.5, 'friction': 5.0}, (0.1, 1.0, 0.1)),
        ({'mu': 0.5, 'mu2': 0.1, 'fdir1': (0.0, 0.0, 3.0)}, (0.2, 0.2, 1.0)),
        ({'mu': 0.5, 'mu2': 0.1, 'fdir1': (1.0, 1.0, 0.0)}, ISOTROPIC),  # along none of its axes
    ],
)
def test_friction_is_scaled_along_the_axis_of_the_lesser_mu(surface, expected):
    assert scales(**surface) == pytest.approx(expected)


def test_mu_acts_along_the_models_y_axis_without_fdir1():
    side = LinkSpec('wheel', Pose((0.0, 0.0, 0.0), from_rpy(-math.pi / 2.0, 0.0, 0.0)))
    assert scales(side, mu=0.5, mu2=0.1) == pytest.approx((0.2, 0.2, 1.0))
    turned = from_rpy(0.0, 0.0, math.pi / 2.0)  # the part's y axis is the link's -x
    assert scales(turn=turned, mu=0.5, mu2=0.1) == pytest.approx((1.0, 0.2, 0.2))


def surface(turn=NO_ROTATION, **given):
    return Collision('c', Box((1, 1, 1)), Pose(orientation=turn), Surface(mu=0.5, mu2=0.1, **given))


@pytest.mark.parametrize(
    ('turn', 'given', 'expected'),
    [
        (NO_ROTATION, (3.0, 0.0, 4.0), (0.6, 0.0, 0.8)),
        (LEFT, (3.0, 4.0, 12.0), (-4.0 / 13.0, 3.0 / 13.0, 12.0 / 13.0)),
    ],
)
def test_first_direction_turns_with_its_collision_and_has_length_1(turn, given, expected):
    found = first_direction(surface(turn, fdir1=given), LinkSpec('l'))
    assert found == pytest.approx(expected)


def test_first_direction_without_fdir1_is_the_models_y_axis():
    link = LinkSpec('l', Pose(orientation=LEFT))
    assert first_direction(surface(), link) == pytest.approx((1.0, 0.0, 0.0))


def test_surfaces_of_equal_friction_in_equal_directions_can_share_a_part():
    x, y = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    assert directions(surface(fdir1=x)) != directions(surface(fdir1=y))
    assert directions(surface(LEFT, fdir1=x))[2] == pytest.approx(directions(surface(fdir1=y))[2])
    assert directions(surface(LEFT)) == directions(surface())
    assert directions(surface()) != directions(surface(fdir1=y))


@pytest.mark.parametrize(('turns', 'can'), [((0.0, math.pi / 2), True), ((0.0, 0.3), False)])
def test_link_can_slip_along_a_common_axis_of_its_parts(turns, can):
    body, places = Body(0), [Place(0, index) for index in range(len(turns))]
    body.surfaces = {'wheel': places}
    body.friction_axes = {
        place: FrictionAxes(from_rpy(turn, 0.0, 0.0), ISOTROPIC)
        for place, turn in zip(places, turns, strict=True)
    }
    assert can_slip(body, 'wheel', (0.0, 1.0, 0.0)) == can
