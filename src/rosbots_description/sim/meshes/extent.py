"""How far shapes reach along the axes of the world."""

import numpy as np

from ..core import Pose, compose
from ..core.arrays import FloatArray, rotation_matrix
from ..description import Box, Cylinder, Geometry, Mesh, Plane, Sphere
from .loader import mesh_ends, read_mesh


def extent(geometry: Geometry, pose: Pose) -> FloatArray | None:
    """Return the lowest and the highest corner (2, 3) of the box around a shape [m].

    It is exact, and None for a plane, which has no end.

    Args:
        pose: of the shape, in the frame along whose axes the box is.
    Raises:
        ModelError: a mesh cannot be read.
    """
    turn = rotation_matrix(pose.orientation)
    match geometry:
        case Box(size):
            reach = np.abs(turn) @ np.divide(size, 2.0)
        case Sphere(radius):
            reach = np.full(3, radius)
        case Cylinder(radius, length):
            along = np.abs(turn[:, 2])
            reach = radius * np.sqrt(np.maximum(1.0 - along**2, 0.0)) + length / 2.0 * along
        case Mesh(path, scale):
            vertices, _ = read_mesh(path).triangles()
            points = (vertices * scale) @ turn.T + pose.position
            return np.array([points.min(axis=0), points.max(axis=0)])
        case Plane():
            return None
    return np.array([pose.position - reach, pose.position + reach])


def rough_extent(geometry: Geometry, pose: Pose) -> FloatArray | None:
    """Return the same, but for a mesh what is around the box around it: no file is read again."""
    if isinstance(geometry, Mesh):
        low, high = mesh_ends(geometry.path) * geometry.scale
        x, y, z = ((low + high) / 2.0).tolist()
        width, depth, height = np.abs(high - low).tolist()
        return extent(Box((width, depth, height)), compose(pose, Pose((x, y, z))))
    return extent(geometry, pose)
