"""Horizontal sections of collision shapes."""

import math
from typing import NamedTuple

import numpy as np

from ..core import Pose
from ..core.arrays import FloatArray, rotation_matrix
from ..description import Box, Cylinder, Geometry, Mesh, Plane, Sphere
from ..meshes import read_mesh

SIDES = 360  # of the polygon for a circle: it lies within 4e-5 radii of it
# Regions and segments are smaller by this part of themselves, and the surfaces of meshes lie deeper
# by this [m]: a face on the border between two cells belongs to the inner one.
SHRINK = 1e-6
_EDGES = np.array([(a, b) for a in range(8) for b in range(a) if (a ^ b).bit_count() == 1])


class Section(NamedTuple):
    """Segments (n, 2, 2) [m]: first and last point, x and y; of a convex region, or of surfaces."""

    segments: FloatArray
    is_region: bool


NOTHING = Section(np.zeros((0, 2, 2)), False)


def section(geometry: Geometry, pose: Pose, height: float) -> Section:
    """Return the section of a shape at a height [m].

    Boxes, cylinders and spheres are solid. Meshes are surfaces, as they are for rays. Planes have
    no end, and no section.

    Raises:
        ModelError: a mesh cannot be read.
    """
    match geometry:
        case Box(size):
            signs = np.array([(n & 1, n >> 1 & 1, n >> 2) for n in range(8)]) - 0.5
            return _region(_placed(signs * size, pose)[_EDGES], height)
        case Cylinder(radius, length):
            ring = radius * _circle()
            low, high = (
                np.column_stack((ring, np.full(SIDES, end * length))) for end in (-0.5, 0.5)
            )
            edges = np.concatenate(
                [
                    np.stack((low, high), axis=1),
                    *(np.stack((one, np.roll(one, 1, axis=0)), axis=1) for one in (low, high)),
                ]
            )
            return _region(_placed(edges, pose), height)
        case Sphere(radius):
            x, y, z = pose.position
            if abs(height - z) >= radius:
                return NOTHING
            return _convex((x, y) + math.sqrt(radius**2 - (height - z) ** 2) * _circle())
        case Mesh(path, scale):
            triangles = [part.vertices[part.faces] for part in read_mesh(path).parts]
            return _surfaces(
                _placed(np.concatenate(triangles) * scale, pose),
                height,
                float(np.prod(np.sign(scale))),
            )
        case Plane():
            return NOTHING


def _circle() -> FloatArray:
    angles = np.arange(SIDES) * 2.0 * math.pi / SIDES
    return np.column_stack((np.cos(angles), np.sin(angles)))


def _placed(points: FloatArray, pose: Pose) -> FloatArray:
    """Return points (…, 3) of a frame in the world."""
    return points @ rotation_matrix(pose.orientation).T + pose.position


def _region(edges: FloatArray, height: float) -> Section:
    """Return the section of the convex solid that has these edges (n, 2, 3)."""
    above = edges[:, :, 2] >= height
    cut = edges[above[:, 0] != above[:, 1]]
    return _convex(_crossing(cut[:, 0], cut[:, 1], height))


def _crossing(a: FloatArray, b: FloatArray, height: float) -> FloatArray:
    """Return x and y where lines from a to b (n, 3) pass a height."""
    share = (height - a[:, 2]) / (b[:, 2] - a[:, 2])
    return a[:, :2] + share[:, None] * (b - a)[:, :2]


def _convex(points: FloatArray) -> Section:
    """Return the convex polygon of points (n, 2) that are all corners of it."""
    if len(points) == 0:
        return NOTHING
    middle = points.mean(axis=0)
    arms = (points - middle) * (1.0 - SHRINK)
    corners = middle + arms[np.argsort(np.arctan2(arms[:, 1], arms[:, 0]))]
    return Section(np.stack((corners, np.roll(corners, -1, axis=0)), axis=1), True)


def _surfaces(triangles: FloatArray, height: float, side: float) -> Section:
    """Return the section of triangles (n, 3, 3); `side` is -1 where corners run clockwise."""
    above = triangles[:, :, 2] >= height
    cut = above.any(axis=1) & ~above.all(axis=1)
    triangles, above = triangles[cut], above[cut]
    # The corner that is alone on its side comes first: both edges from there are cut.
    alone = np.where(above.sum(axis=1) == 1, above.argmax(axis=1), (~above).argmax(axis=1))
    a, b, c = (triangles[np.arange(len(triangles)), (alone + n) % 3] for n in range(3))
    normals = side * np.cross(b - a, c - a)[:, :2]
    inward = -normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    segments = np.stack((_crossing(a, b, height), _crossing(a, c, height)), axis=1)
    middles = segments.mean(axis=1, keepdims=True)
    segments = middles + (1.0 - SHRINK) * (segments - middles) + SHRINK * inward[:, None]
    return Section(segments, False)
