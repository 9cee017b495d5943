"""Finds occluded shapes of a body: those that no plane can touch.

A plane touches a body only on the body's convex hull. PyBullet tests each shape of a body against
a plane in each step; for a robot of plates and posts most of these tests are needless.
"""

import math
from collections.abc import Sequence
from functools import lru_cache
from itertools import product
from pathlib import Path

import numpy as np

from ...core import Pose, rotate
from ...core.arrays import FloatArray, IntArray
from ...description import Box, Collision, Cylinder, Geometry, Mesh, Plane, Sphere
from ...meshes import read_stl, support_points
from .generated_urdf import MeshFile

_MARGIN = 1e-6  # margin for rounding, as a share of the body's size
_MAX_CORNERS = 40  # vertices of a hull; finding its sides takes time with the cube of their number
_AT_ONCE = 1000  # planes in a batch that stays within memory already allocated
_CUBE = np.array(list(product((-1.0, 1.0), repeat=3)))
_POLES = np.concatenate([np.eye(3), -np.eye(3)])
_RIM = [(math.cos(k * math.pi / 4.0), math.sin(k * math.pi / 4.0)) for k in range(8)]
_RIMS = np.array([(x, y, z) for x, y in _RIM for z in (-1.0, 1.0)])
_DIRECTIONS = np.array([way for way in product((-1.0, 0.0, 1.0), repeat=3) if any(way)])


def occluded_shapes(collisions: Sequence[Collision], mesh_file: MeshFile) -> tuple[bool, ...]:
    """Tell for each shape of a rigid body whether it surely lies within the hull of the others.

    Args:
        collisions: shapes of the body.
        mesh_file: returns the .stl file of a mesh's hull, named by its contents.
    """
    shapes = [one.geometry for one in collisions]
    if any(isinstance(shape, Plane) for shape in shapes):
        return (False,) * len(shapes)
    files = (mesh_file(shape) if isinstance(shape, Mesh) else shape for shape in shapes)
    return _inner(tuple(zip(files, (one.pose for one in collisions), strict=True)))


@lru_cache(maxsize=64)  # the same model is often spawned again
@np.errstate(all='ignore')  # shapes of absurd size never count as occluded
def _inner(shapes: tuple[tuple[Geometry | str, Pose], ...]) -> tuple[bool, ...]:
    outlines = [_points(shape) for shape, _ in shapes]
    poses = [pose for _, pose in shapes]
    placed = [_placed(outline, pose) for outline, pose in zip(outlines, poses, strict=True)]
    points = np.concatenate(placed)
    owners = np.repeat(np.arange(len(placed)), [len(some) for some in placed])
    # A hull of few support points, then one refined by support points beyond its sides.
    corners = support_points(points, _DIRECTIONS)
    sides, _ = _hull(points[corners])
    corners += sorted({*support_points(points, sides)} - {*corners})
    corners = corners[:_MAX_CORNERS]
    sides, reaches = _hull(points[corners])
    if not len(sides):
        return (False,) * len(shapes)
    outer = set(owners[corners].tolist())
    boxes = [_placed(_box(outline), pose) for outline, pose in zip(outlines, poses, strict=True)]
    return tuple(
        i not in outer and bool((box @ sides.T <= reaches).all()) for i, box in enumerate(boxes)
    )


def _points(shape: Geometry | str) -> FloatArray:
    """Return points (n, 3) of a shape's surface that span its bounding box [m]."""
    points: FloatArray
    match shape:
        case Box(size):
            points = _CUBE * np.array(size) / 2.0
        case Sphere(radius):
            points = _POLES * radius
        case Cylinder(radius, length):
            points = _RIMS * (radius, radius, length / 2.0)
        case str():
            points = read_stl(Path(shape).read_bytes()).reshape(-1, 3)
        case _:
            raise TypeError(f'{shape} has no points')
    return points


def _box(points: FloatArray) -> FloatArray:
    """Return the corners (8, 3) of the axis-aligned bounding box of points."""
    low, high = points.min(axis=0), points.max(axis=0)
    corners: FloatArray = (low + high) / 2.0 + _CUBE * (high - low) / 2.0
    return corners


def _placed(points: FloatArray, pose: Pose) -> FloatArray:
    x, y, z = points.T
    turned = np.stack(rotate(pose.orientation, (x, y, z)), axis=1)
    placed: FloatArray = turned + np.array(pose.position)
    return placed


def _hull(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the sides of the hull of a few points: normals (n, 3) and offsets (n,) [m].

    A side is a plane through three points with all others behind it. Coplanar points give no sides.
    """
    size = np.ptp(points, axis=0).max()
    margin = _MARGIN * size
    triples = _triples(len(points))
    sides, reaches = [np.empty((0, 3))], [np.empty(0)]
    for start in range(0, triples.shape[1], _AT_ONCE):
        a, b, c = points[triples[:, start : start + _AT_ONCE]]
        normals = np.cross(b - a, c - a)
        lengths = np.sqrt((normals**2).sum(axis=1))
        real = lengths > margin * size
        normals, a = normals[real] / lengths[real, None], a[real]
        reach = (normals * a).sum(axis=1)
        heights = normals @ points.T
        lowest, highest = heights.min(axis=1) - reach, heights.max(axis=1) - reach
        if (highest - lowest <= margin).any():
            return np.empty((0, 3)), np.empty(0)
        for way, outer in ((1.0, highest <= margin), (-1.0, lowest >= -margin)):
            sides.append(way * normals[outer])
            reaches.append(way * reach[outer] + margin)
    return np.concatenate(sides), np.concatenate(reaches)


@lru_cache(maxsize=16)
def _triples(count: int) -> IntArray:
    """Return all index triples i < j < k below `count`, shape (3, n)."""
    i = np.arange(count)
    return np.stack(np.nonzero((i[:, None, None] < i[:, None]) & (i[:, None] < i)))
