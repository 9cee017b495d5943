"""Boxes around what is seen."""

from collections.abc import Iterable
from itertools import product

from ..sim.core import IDENTITY, ModelError, Pose, Vector, compose
from ..sim.description import Geometry, Visual
from ..sim.meshes import rough_extent


def corners(visuals: Iterable[Visual]) -> list[Vector]:
    """Return the corners of boxes around visuals, in the frame of their link [m].

    A plane has none, nor has a mesh that cannot be read.
    """
    return [compose(visual.pose, Pose(corner)).position
            for visual in visuals for corner in _corners(visual.geometry)]


def _corners(geometry: Geometry) -> list[Vector]:
    """Return the corners of a box around a shape, in its frame [m]; none for a plane."""
    try:
        ends = rough_extent(geometry, IDENTITY)
    except ModelError:  # a mesh that is not shown
        return []
    return [] if ends is None else list(product(*ends.T.tolist()))
