"""Boxes around shapes at any pose."""

import math

import numpy as np
import pytest

from rosbots_description.sim.core.transforms import Pose, from_rpy
from rosbots_description.sim.description import Box, Cylinder, Mesh, Plane, Sphere
from rosbots_description.sim.meshes import extent, rough_extent

ROOT = math.sqrt(0.5)
TIP = """solid s
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 2 3
endloop
endfacet
endsolid
"""


@pytest.mark.parametrize(
    ('shape', 'roll', 'half'),
    [
        (Box((2.0, 4.0, 6.0)), 0.0, (1.0, 2.0, 3.0)),
        (Box((2.0, 4.0, 6.0)), math.pi / 2.0, (1.0, 3.0, 2.0)),
        (Box((2.0, 2.0, 2.0)), math.pi / 4.0, (1.0, 2.0 * ROOT, 2.0 * ROOT)),
        (Sphere(2.0), 1.0, (2.0, 2.0, 2.0)),
        (Cylinder(1.0, 4.0), math.pi / 2.0, (1.0, 2.0, 1.0)),
        (Cylinder(1.0, 4.0), math.pi / 4.0, (1.0, 3.0 * ROOT, 3.0 * ROOT)),
    ],
)
def test_box_around_a_shape_is_exact(shape, roll, half):
    pose = Pose((10.0, 0.0, -5.0), from_rpy(roll, 0.0, 0.0))
    low, high = extent(shape, pose)
    assert low == pytest.approx(np.subtract(pose.position, half))
    assert high == pytest.approx(np.add(pose.position, half))


def test_box_around_a_mesh_is_that_of_its_vertices(tmp_path):
    path = tmp_path / 'tip.stl'
    path.write_text(TIP)
    low, high = extent(
        Mesh(str(path), (1.0, 1.0, 2.0)), Pose((0.0, 0.0, 1.0), from_rpy(math.pi, 0.0, 0.0))
    )
    assert low == pytest.approx((0.0, -2.0, -5.0))
    assert high == pytest.approx((1.0, 0.0, 1.0))


def test_rough_box_around_a_mesh_is_that_around_its_box(tmp_path):
    path = tmp_path / 'tip.stl'
    path.write_text(TIP)
    pose = Pose((0.0, 0.0, 1.0), from_rpy(math.pi / 4.0, 0.0, 0.0))
    low, high = rough_extent(Mesh(str(path), (1.0, 1.0, -1.0)), pose)
    assert low == pytest.approx((0.0, 0.0, 1.0 - 3.0 * ROOT))
    assert high == pytest.approx((1.0, 5.0 * ROOT, 1.0 + 2.0 * ROOT))
    box = Box((1.0, 2.0, 3.0))
    assert rough_extent(box, pose) == pytest.approx(extent(box, pose))


def test_plane_has_no_end():
    assert extent(Plane(), Pose((0.0, 0.0, 0.0))) is None
