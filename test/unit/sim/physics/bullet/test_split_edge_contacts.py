"""Shapes with edges are doubled, so that a body touches a floor with both ends of an edge."""

import math
from dataclasses import replace
from itertools import product

import pytest

from rosbots_description.sim.core.transforms import (
    IDENTITY,
    Pose,
    compose,
    conjugate,
    from_rpy,
    multiply,
    rotate,
)
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
WHEEL = LinkSpec(
    'wheel',
    Pose((0.0, 0.2, 0.1), from_rpy(QUARTER, 0.0, 0.0)),
    MASS,
    (Collision('tyre', Cylinder(0.1, 0.05)),),
)
JOINT = JointSpec('axle', REVOLUTE, 'body', 'wheel')


def corners(collision):
    """Return the eight corners of a box in its parent frame [m]."""
    x, y, z = collision.geometry.size
    return [
        compose(collision.pose, Pose((i * x, j * y, k * z))).position
        for i, j, k in product((-0.5, 0.5), repeat=3)
    ]


def lowest_side(collision):
    """Return the y [m] of the lowest corners."""
    return min(corners(collision), key=lambda corner: corner[2])[1]


@pytest.mark.parametrize(
    'turn',
    [
        (0.0, 0.0, 0.0),
        (0.0, 0.0, QUARTER),
        (QUARTER, 0.0, 0.0),
        (0.0, 0.3, 0.0),
        (0.0, 0.0, 0.4),
    ],
)
def test_box_is_doubled_and_each_copy_is_lowest_on_its_side(turn):
    box = Collision('box', Box((0.5, 0.3, 0.1)), Pose((0.2, 0.0, 0.1), from_rpy(*turn)))
    both = split_edges([box], AXLE, UP)
    for one in both:
        for corner, original in zip(corners(one), corners(box), strict=True):
            assert 0.0 < math.dist(corner, original) < 1e-4
    assert sorted(math.copysign(1.0, lowest_side(one)) for one in both) == [-1.0, 1.0]


def test_copies_in_an_upside_down_frame_are_highest_on_their_side():
    for lower, upper in zip(
        split_edges([BOX], AXLE, DOWN), split_edges([BOX], AXLE, UP), strict=True
    ):
        assert lowest_side(lower) == pytest.approx(-lowest_side(upper), abs=1e-4)


@pytest.mark.parametrize('yaw', [0.0, 0.7, 2.5])
def test_copies_are_tilted_by_02_mrad_to_either_side_about_the_way_ahead(yaw):
    turn = from_rpy(0.0, 0.0, yaw)
    lower, upper = split_edges([BOX], rotate(turn, AXLE), UP)
    for one, expected in ((lower, 2e-4), (upper, -2e-4)):
        *axis, _ = multiply(one.pose.orientation, conjugate(BOX.pose.orientation))
        ahead = rotate(turn, (math.sin(expected / 2.0), 0.0, 0.0))
        assert axis == pytest.approx(ahead, rel=1e-6, abs=1e-12)


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


@pytest.mark.parametrize('roll', [0.0, math.pi])
def test_edges_are_split_about_the_axle_and_the_vertical_in_the_frame_of_the_body(roll):
    body = replace(BODY, pose=Pose((0.0, 0.0, 0.2), from_rpy(roll, 0.0, 0.0)))
    (group,) = body_groups(Tree([body, WHEEL], [None, JOINT], fixed_base=False))
    side = math.cos(roll)  # where the axle, the world's -y axis here, and the vertical point
    for one, other in zip(
        group, split_edges(body.collisions, (0.0, -side, 0.0), (0.0, 0.0, side)), strict=True
    ):
        assert one.pose.orientation == pytest.approx(other.pose.orientation, abs=1e-12)


def test_body_with_a_wheel_as_thin_as_a_crest_has_split_edge_contacts():
    thin = replace(WHEEL, collisions=(Collision('tyre', Cylinder(0.1, 0.001)),))
    tree = Tree([BODY, thin], [None, JOINT], fixed_base=False)
    assert [kinds(group) for group in body_groups(tree)] == [[Box, Box, Sphere]]


@pytest.mark.parametrize(
    'tree',
    [
        Tree([BODY], [None], fixed_base=False),
        Tree([BODY, WHEEL], [None, JOINT], fixed_base=True),
        Tree(
            [BODY, LinkSpec('arm', IDENTITY, MASS), WHEEL],
            [
                None,
                JointSpec('elbow', REVOLUTE, 'body', 'arm'),
                JointSpec('axle', REVOLUTE, 'arm', 'wheel'),
            ],
            fixed_base=False,
        ),
    ],
)
def test_body_without_a_wheel_is_unchanged(tree):
    assert body_groups(tree) == [BODY.collisions]
