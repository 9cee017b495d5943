"""Shapes with edges are doubled, so that a body touches a floor with both ends of an edge."""

import math
from itertools import product

import pytest

from rosbots_description.sim.core.transforms import IDENTITY, Pose, compose, from_rpy
from rosbots_description.sim.description.model_spec import (
    REVOLUTE,
    Box,
    Collision,
    Cylinder,
    Inertial,
    JointSpec,
    LinkSpec,
    Mesh,
    Sphere,
)
from rosbots_description.sim.physics.bullet.generated_urdf import Tree
from rosbots_description.sim.physics.bullet.shape_groups import surface_groups, with_split_edges
from rosbots_description.sim.physics.bullet.split_edge_contacts import split_edges

AXLE, UP, DOWN = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
QUARTER = math.pi / 2.0
BOX = Collision('box', Box((0.5, 0.3, 0.1)), Pose((0.1, 0.0, 0.2)))
MASS = Inertial(1.0, ixx=1.0, iyy=1.0, izz=1.0)
BODY = LinkSpec('body', Pose((0.0, 0.0, 0.2)), MASS, (BOX, Collision('skid', Sphere(0.05))))
WHEEL = LinkSpec('wheel', Pose((0.0, 0.2, 0.1), from_rpy(QUARTER, 0.0, 0.0)), MASS,
                 (Collision('tyre', Cylinder(0.1, 0.05)),))
JOINT = JointSpec('axle', REVOLUTE, 'body', 'wheel')


def corners(collision):
    """Return the eight corners of a box in its parent frame [m]."""
    x, y, z = collision.geometry.size
    return [compose(collision.pose, Pose((i * x, j * y, k * z))).position
            for i, j, k in product((-0.5, 0.5), repeat=3)]


def lowest_side(collision):
    """Return the y [m] of the lowest corners."""
    return min(corners(collision), key=lambda corner: corner[2])[1]


@pytest.mark.parametrize('turn', [
    (0.0, 0.0, 0.0), (0.0, 0.0, QUARTER), (QUARTER, 0.0, 0.0), (0.0, 0.3, 0.0), (0.0, 0.0, 0.4),
])
def test_box_is_doubled_and_each_copy_is_lowest_on_its_side(turn):
    box = Collision('box', Box((0.5, 0.3, 0.1)), Pose((0.2, 0.0, 0.1), from_rpy(*turn)))
    both = split_edges([box], AXLE, UP)
    for one in both:
        for corner, original in zip(corners(one), corners(box), strict=True):
            assert 0.0 < math.dist(corner, original) < 1e-4
    assert sorted(math.copysign(1.0, lowest_side(one)) for one in both) == [-1.0, 1.0]


def test_copies_in_an_upside_down_frame_are_highest_on_their_side():
    for lower, upper in zip(
            split_edges([BOX], AXLE, DOWN), split_edges([BOX], AXLE, UP), strict=True):
        assert lowest_side(lower) == pytest.approx(-lowest_side(upper), abs=1e-4)


def test_round_shape_is_not_doubled():
    shapes = [Collision('ball', Sphere(0.1)), Collision('can', Cylinder(0.1, 0.2))]
    assert split_edges(shapes, AXLE, UP) == tuple(shapes)


def test_mesh_is_doubled():
    assert len(split_edges([Collision('hull', Mesh('hull.stl'))], AXLE, UP)) == 2


def kinds(group):
    return [type(shape.geometry) for shape in group]


def body_groups(tree):
    return with_split_edges(tree, surface_groups(tree, 0))


def test_body_with_a_wheel_has_split_edge_contacts():
    tree = Tree([BODY, WHEEL], [None, JOINT], fixed_base=False)
    assert [kinds(group) for group in body_groups(tree)] == [[Box, Box, Sphere]]
    assert [kinds(group) for group in surface_groups(tree, 1)] == [[Cylinder] * 4]  # its profile


@pytest.mark.parametrize('tree', [
    Tree([BODY], [None], fixed_base=False),
    Tree([BODY, WHEEL], [None, JOINT], fixed_base=True),
    Tree([BODY, LinkSpec('arm', IDENTITY, MASS), WHEEL],
         [None, JointSpec('elbow', REVOLUTE, 'body', 'arm'),
          JointSpec('axle', REVOLUTE, 'arm', 'wheel')], fixed_base=False),
])
def test_body_without_a_wheel_is_unchanged(tree):
    assert body_groups(tree) == [BODY.collisions]
