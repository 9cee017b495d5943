"""Boxes around what is seen."""

import contextlib
from collections.abc import Iterable
from itertools import product

from ...sim.core import IDENTITY, ModelError, Pose, Vector, compose
from ...sim.description import Visual
from ...sim.meshes import rough_extent


def corners(visuals: Iterable[Visual], link: Pose = IDENTITY) -> list[Vector]:
    """Return the corners of boxes around visuals [m], in the frame in which `link` is their link's.

    Eight of each, z changing first. A plane has none, nor has a mesh that cannot be read.
    """
    found: list[Vector] = []
    for visual in visuals:
        with contextlib.suppress(ModelError):  # it is not shown
            ends = rough_extent(visual.geometry, IDENTITY)
            if ends is not None:
                place = compose(link, visual.pose)
                found += [
                    compose(place, Pose(corner)).position for corner in product(*ends.T.tolist())
                ]
    return found
