"""Which shapes of a body lie within the hull of the others."""

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
    """Return the names of those that are within."""
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
def test_what_stands_between_two_plates_is_within_them(shape, within):
    assert inner(*PLATES, shape) == ({shape.name} if within else set())
    assert inner(shape, *PLATES) == ({shape.name} if within else set())


def test_what_is_flush_with_plates_that_come_first_is_within_them():
    assert inner(*PLATES, Collision('post', Cylinder(0.02, 0.21), Pose((0.15, 0.1, 0.2))))


def test_of_twins_one_touches():
    assert len(inner(*PLATES, *PLATES)) == 2


@pytest.mark.parametrize('alone', [Box((1.0, 1.0, 1.0)), Sphere(1.0), Cylinder(1.0, 1.0)])
def test_what_is_alone_touches(alone):
    assert not inner(Collision('alone', alone))


def test_beside_a_plane_everything_touches():
    assert not inner(*PLATES, Collision('post', Sphere(0.01), Pose((0.0, 0.0, 0.2))),
                     Collision('ground', Plane((0.0, 0.0, 1.0))))


@pytest.mark.parametrize('size', [1e-300, 1e-9, 1e9, 1e200, 1.7e308])
def test_absurd_sizes_are_no_fault(size):
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        found = inner(*PLATES, Collision('odd', Box((size,) * 3), Pose((size, 0.0, 0.2), TURN)))
    assert ('odd' in found) == (size < 1.0)


def test_of_the_robot_of_the_article_plates_and_caster_touch():
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
WAYS = np.random.default_rng(1).normal(size=(200, 3))
WAYS /= np.linalg.norm(WAYS, axis=1)[:, None]


def reach(collision, way):
    """Return how far a shape reaches in a direction [m]."""
    q = collision.pose.orientation
    x, y, z = rotate((-q[0], -q[1], -q[2], q[3]), tuple(way))
    match collision.geometry:
        case Box((a, b, c)):
            far = (a * abs(x) + b * abs(y) + c * abs(z)) / 2.0
        case Sphere(radius):
            far = radius
        case Cylinder(radius, length):
            far = radius * np.hypot(x, y) + length * abs(z) / 2.0
    return far + float(np.dot(way, collision.pose.position))


@given(st.lists(st.builds(Collision, st.just('one'), shapes, places), min_size=2, max_size=8))
def test_nothing_that_is_within_reaches_beyond_all_that_touch(collisions):
    marks = occluded_shapes(collisions, None)
    touching = [one for one, mark in zip(collisions, marks, strict=True) if not mark]
    for one, mark in zip(collisions, marks, strict=True):
        for way in WAYS if mark else ():
            assert reach(one, way) <= max(reach(other, way) for other in touching) + 1e-5
