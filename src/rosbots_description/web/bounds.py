"""Boxes around what is seen."""

from collections.abc import Iterable
from itertools import product

import numpy as np

from ..sim.core import ModelError, Pose, Vector, compose
from ..sim.description import Box, Cylinder, Geometry, Mesh, Plane, Sphere, Visual
from ..sim.meshes import read_mesh


def corners(visuals: Iterable[Visual]) -> list[Vector]:
    """Return the corners of boxes around visuals, in the frame of their link [m].

    A plane has none, nor has a mesh that cannot be read.
    """
    return [compose(visual.pose, Pose(corner)).position
            for visual in visuals for corner in _corners(visual.geometry)]


def _corners(geometry: Geometry) -> list[Vector]:
    """Return the corners of a box around a shape, in its frame [m]; none for a plane."""
    match geometry:
        case Box(size):
            high = np.divide(size, 2.0)
        case Sphere(radius):
            high = np.full(3, radius)
        case Cylinder(radius, length):
            high = np.array([radius, radius, length / 2.0])
        case Mesh(path, scale):
            try:
                vertices, _ = read_mesh(path).triangles()
            except ModelError:  # it is not shown
                return []
            ends = np.multiply([vertices.min(axis=0), vertices.max(axis=0)], scale)
            return list(product(*ends.T.tolist()))
        case Plane():
            return []
    return list(product(*np.stack([-high, high], axis=1).tolist()))
