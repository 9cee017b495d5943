"""The solids of a link for ray casts: where they are when the link is somewhere."""

import itertools
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core import Pose, Vector
from ..core.arrays import rotation_matrix

Floats = NDArray[np.float64]

_SIGNS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))  # of a box's corners


class LinkSolids(NamedTuple):
    """The solids of a link, in its frame.

    Attributes:
        rows: (k,) their numbers in the scene.
        centres: (k, 3) of their bounding boxes [m].
        axes: (k, 3, 3) rotations from their frames.
        corners: (3, 8, k) of the boxes, relative to the centres [m].
    """

    rows: NDArray[np.int64]
    centres: Floats
    axes: Floats
    corners: Floats

    @classmethod
    def of(
        cls, rows: Sequence[int], poses: Sequence[Pose], halves: Floats,
        offsets: Mapping[int, Vector],
    ) -> 'LinkSolids':
        """Return the solids of a link.

        Args:
            rows: their numbers in the scene.
            poses: in the frame of the link.
            halves: (3, n) half extents of all solids of the scene [m].
            offsets: of the centres of bounding boxes from the solids' frames [m], by row.
        """
        axes = np.array([rotation_matrix(pose.orientation) for pose in poses]).reshape(-1, 3, 3)
        centres = np.array([pose.position for pose in poses]).reshape(-1, 3)
        for i, row in enumerate(rows):
            if row in offsets:
                centres[i] += axes[i] @ offsets[row]
        boxes = _SIGNS * halves[:, rows].T[:, None]  # (k, 8, 3)
        corners = (axes @ boxes.transpose(0, 2, 1)).transpose(1, 2, 0).copy()
        return cls(np.array(rows, np.int64), centres, axes, corners)

    def at(self, pose: Pose) -> tuple[Floats, Floats, Floats]:
        """Return centres, axes and corners with the link at a pose."""
        turn = rotation_matrix(pose.orientation)
        corners = (turn @ self.corners.reshape(3, -1)).reshape(self.corners.shape)
        return self.centres @ turn.T + pose.position, turn @ self.axes, corners
