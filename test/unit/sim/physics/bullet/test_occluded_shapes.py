"""Shapes of a body within the convex hull of the others."""

import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import robot_spec

from rosbots_description.sim.core.transforms import Pose, from_rpy, rotate
from rosbots_description.sim.description.model_spec import (
    Box,
    Collision,
    Cylinder,
    Mesh,
    Plane,
    Sphere,
)
from rosbots_description.sim.meshes.engine_files import EngineFiles
from rosbots_description.sim.physics.bullet.occluded_shapes import occluded_shapes

PLATES = [
    Collision('lower', Box((0.4, 0.3, 0.01)), Pose((0.0, 0.0, 0.1))),
    Collision('upper', Box((0.4, 0.3, 0.01)), Pose((0.0, 0.0, 0.3))),
]
TURN = from_rpy(0.3, 0.2, 0.1)


def inner(*collisions):
    """Return the names of the occluded collisions."""
    marks = occluded_shapes(collisions, None)
    return {one.name for one, mark in zip(collisions, marks, strict=True) if mark}


@pytest.mark.parametrize(('shape', 'within'), [
    (Collision('post', Cylinder(0.02, 0.19), Pose((0.15, 0.1, 0.2))), True),
    (Collision('post', Cylinder(0.02, 0.22), Pose((0.15, 0.1, 0.2))), False),
    (Collision('post', Cylinder(0.02, 0.19), Pose((0.181, 0.1, 0.2))), False),
    (Collision('ball', Sphere(0.09), Pose((0.0, 0.0, 0.2))), True),
    (Collision('ball', Sphere(0.05), Pose((0.0, 0.0, 0.1))), False),
    (Collision('box', Box((0.2, 0.2, 0.1)), Pose((0.0, 0.0, 0.2), from_rpy(0.1, 0.1, 0.8))), True),
    (Collision('box', Box((0.2, 0.4, 0.1)), Pose((0.0, 0.0, 0.2))), False),
])
def test_shape_between_two_plates_is_occluded(shape, within):
    assert inner(*PLATES, shape) == ({shape.name} if within else set())
    assert inner(shape, *PLATES) == ({shape.name} if within else set())


def test_shape_flush_with_earlier_plates_is_occluded():
    assert inner(*PLATES, Collision('post', Cylinder(0.02, 0.21), Pose((0.15, 0.1, 0.2))))


def test_one_of_two_equal_shapes_is_occluded():
    assert len(inner(*PLATES, *PLATES)) == 2


@pytest.mark.parametrize('alone', [Box((1.0, 1.0, 1.0)), Sphere(1.0), Cylinder(1.0, 1.0)])
def test_single_shape_is_not_occluded(alone):
    assert not inner(Collision('alone', alone))


def test_no_shape_is_occluded_beside_a_plane():
    assert not inner(*PLATES, Collision('post', Sphere(0.01), Pose((0.0, 0.0, 0.2))),
                     Collision('ground', Plane((0.0, 0.0, 1.0))))


@pytest.mark.parametrize('size', [1e-300, 1e-9, 1e9, 1e200, 1.7e308])
def test_extreme_sizes_are_accepted(size):
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        found = inner(*PLATES, Collision('odd', Box((size,) * 3), Pose((size, 0.0, 0.2), TURN)))
    assert ('odd' in found) == (size < 1.0)


def test_plates_and_caster_of_the_articles_robot_are_not_occluded():
    collisions, meshes = robot_spec().links[0].collisions, EngineFiles()
    files = {one.geometry: meshes.engine_file(one.geometry, exact=False)
             for one in collisions if isinstance(one.geometry, Mesh)}
    marks = occluded_shapes(collisions, files.__getitem__)
    meshes.close()
    touching = {one.name for one, mark in zip(collisions, marks, strict=True) if not mark}
    names = ('base_link', 'base_second_link', 'caster_back_link', 'mcu_link_1')
    assert len(touching) == len(names)
    assert all(any(f'__{name}_collision' in one for one in touching) for name in names)


sizes = st.floats(0.01, 1.0)
shapes = st.one_of(
    st.builds(Box, st.tuples(sizes, sizes, sizes)),
    st.builds(Sphere, sizes),
    st.builds(Cylinder, sizes, sizes),
)
places = st.builds(
    Pose,
    st.tuples(*[st.floats(-1.0, 1.0)] * 3),
    st.builds(from_rpy, *[st.floats(-3.0, 3.0)] * 3),
)
DIRECTIONS = np.random.default_rng(1).normal(size=(200, 3))
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1)[:, None]


def extent(collision, direction):
    """Return how far a shape reaches in a direction [m]."""
    q = collision.pose.orientation
    x, y, z = rotate((-q[0], -q[1], -q[2], q[3]), tuple(direction))
    match collision.geometry:
        case Box((a, b, c)):
            far = (a * abs(x) + b * abs(y) + c * abs(z)) / 2.0
        case Sphere(radius):
            far = radius
        case Cylinder(radius, length):
            far = radius * np.hypot(x, y) + length * abs(z) / 2.0
    return far + float(np.dot(direction, collision.pose.position))


@given(st.lists(st.builds(Collision, st.just('one'), shapes, places), min_size=2, max_size=8))
def test_occluded_shapes_do_not_extend_beyond_the_others(collisions):
    marks = occluded_shapes(collisions, None)
    touching = [one for one, mark in zip(collisions, marks, strict=True) if not mark]
    for one, mark in zip(collisions, marks, strict=True):
        for direction in DIRECTIONS if mark else ():
            most = max(extent(other, direction) for other in touching)
            assert extent(one, direction) <= most + 1e-5
