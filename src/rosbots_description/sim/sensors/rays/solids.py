"""The solids of a ray scene: where they are when their links are somewhere."""

import itertools
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ...core import Pose, Vector
from ...core.arrays import rotation_matrices

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

_SIGNS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))  # of a box's corners


class LinkSolids:
    """All n solids of a scene, each fixed to a link.

    Attributes:
        centres: (n, 3) of their bounding boxes, in the world [m].
        axes: (n, 3, 3) rotations from their frames to the world.
    """

    def __init__(
        self, links: Sequence[int], poses: Sequence[Pose], offsets: Mapping[int, Vector]
    ) -> None:
        """Prepare; `place` tells where they are.

        Args:
            links: (n,) the number of the link of each.
            poses: (n,) in the frames of the links.
            offsets: of the centres of bounding boxes from the solids' frames [m], by row.
        """
        self._links = np.array(links, np.int64)
        turned = np.array([pose.orientation for pose in poses]).reshape(-1, 4)
        self._axes = rotation_matrices(turned)  # in the frames of the links, as the next
        self._centres = np.array([pose.position for pose in poses]).reshape(-1, 3)
        for row, offset in offsets.items():
            self._centres[row] += self._axes[row] @ offset
        self.centres, self.axes = np.zeros_like(self._centres), np.zeros_like(self._axes)

    def of(self, links: Sequence[int]) -> tuple[Indices, Indices]:
        """Return the rows of the solids of some links, ascending, and the place of each's link."""
        places = np.full(max(self._links, default=0) + 1, -1)
        places[[link for link in links if link < len(places)]] = [
            place for place, link in enumerate(links) if link < len(places)
        ]
        of_all = places[self._links]
        rows = np.flatnonzero(of_all >= 0)
        return rows, of_all[rows]

    def place(self, rows: Indices, links: Indices, poses: Floats) -> None:
        """Update some solids.

        Args:
            rows: (k,) of the solids.
            links: (k,) the row of each solid's link in `poses`.
            poses: (l, 7) of links: position [m], quaternion x, y, z, w.
        """
        turns = rotation_matrices(poses[:, 3:])[links]
        self.axes[rows] = turns @ self._axes[rows]
        self.centres[rows] = (turns @ self._centres[rows, :, None])[:, :, 0] + poses[links, :3]


def corners_of(axes: Floats, halves: Floats) -> Floats:
    """Return the corners (3, 8, m) of boxes, relative to their centres [m].

    Args:
        axes: (m, 3, 3) rotations from their frames.
        halves: (3, m) half extents [m].
    """
    corners: Floats = np.einsum('kij,jk,cj->ick', axes, halves, _SIGNS)
    return corners
