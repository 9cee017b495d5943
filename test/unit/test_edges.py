"""Boxes of a robot's body come as two halves that touch a floor with the outer corner each."""

import math
from itertools import product

import pytest

from rosbots_description.sim.bullet_description import Tree
from rosbots_description.sim.edges import halves
from rosbots_description.sim.pose import Pose, compose, from_rpy
from rosbots_description.sim.spec import (
    REVOLUTE,
    Box,
    Collision,
    Cylinder,
    Inertial,
    JointSpec,
    LinkSpec,
    Sphere,
)
from rosbots_description.sim.surfaces import surface_groups

AXLE, UP = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
QUARTER = math.pi / 2.0
BODY = LinkSpec('body', Pose((0.0, 0.0, 0.2)), Inertial(1.0, ixx=1.0, iyy=1.0, izz=1.0),
                (Collision('box', Box((0.5, 0.3, 0.1))),))
WHEEL = LinkSpec('wheel', Pose((0.0, 0.2, 0.1), from_rpy(QUARTER, 0.0, 0.0)),
                 collisions=(Collision('tyre', Cylinder(0.1, 0.05)),))
JOINT = JointSpec('axle', REVOLUTE, 'body', 'wheel')


def corners(collision):
    """Return the eight corners of a box, in the frame that it is given in [m]."""
    x, y, z = collision.geometry.size
    return [compose(collision.pose, Pose((i * x, j * y, k * z))).position
            for i, j, k in product((-0.5, 0.5), repeat=3)]


@pytest.mark.parametrize('turn', [
    (0.0, 0.0, 0.0), (0.0, 0.0, QUARTER), (QUARTER, 0.0, 0.0), (0.0, 0.3, 0.0), (0.0, 0.0, 0.02),
])
def test_the_halves_fill_the_box_and_reach_lowest_at_its_sides(turn):
    box = Collision('box', Box((0.5, 0.3, 0.1)), Pose((1.0, 2.0, 3.0), from_rpy(*turn)))
    both = sorted(halves(box, AXLE, UP), key=lambda half: half.pose.position[1])
    for whole in corners(box):
        nearest = min((math.dist(whole, corner), corner)
                      for half in both for corner in corners(half))
        assert nearest[0] < 1e-4
        assert nearest[1][2] == pytest.approx(whole[2], abs=1e-4)
    for half, side in zip(both, (-1.0, 1.0), strict=True):
        across = sorted(corners(half), key=lambda corner: side * corner[1])
        inner, outer = across[:4], across[4:]
        lowest = [min(z for _, _, z in some) for some in (inner, outer)]
        assert 1e-6 < lowest[0] - lowest[1] < 2e-4


def test_of_a_body_whose_frame_is_upside_down_the_other_side_is_the_lower():
    box = Collision('box', Box((0.5, 0.3, 0.1)), Pose((1.0, 2.0, 3.0)))
    for half in halves(box, AXLE, (0.0, 0.0, -1.0)):
        by_distance = sorted(corners(half), key=lambda corner: abs(corner[1] - 2.0))
        inner, outer = (max(z for _, _, z in some) for some in (by_distance[:4], by_distance[4:]))
        assert inner < outer


@pytest.mark.parametrize('collision', [
    Collision('ball', Sphere(0.1)),
    Collision('box', Box((1.0, 1.0, 1.0)), Pose((0.0, 0.0, 0.0), from_rpy(0.0, 0.0, 0.3))),
])
def test_what_is_no_box_along_the_axle_stays_as_it_is(collision):
    assert halves(collision, AXLE, UP) == (collision,)


def test_the_body_that_carries_a_wheel_comes_in_halves():
    tree = Tree([BODY, WHEEL], [None, JOINT], fixed_base=False)
    (shapes,) = surface_groups(tree, 0)
    assert [shape.geometry.size for shape in shapes] == [(0.5, 0.15, 0.1)] * 2


@pytest.mark.parametrize('tree', [
    Tree([BODY], [None], fixed_base=False),
    Tree([BODY, WHEEL], [None, JOINT], fixed_base=True),
    Tree([BODY, LinkSpec('arm'), WHEEL],
         [None, JointSpec('elbow', REVOLUTE, 'body', 'arm'), JointSpec('a', REVOLUTE, 'arm', 'w')],
         fixed_base=False),
])
def test_a_body_without_wheels_comes_in_one(tree):
    assert surface_groups(tree, 0) == [BODY.collisions]
