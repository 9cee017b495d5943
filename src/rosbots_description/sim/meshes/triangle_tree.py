"""Ray casts on triangles by a tree of boxes, in numpy: for machines without Embree, as arm64.

The tree is complete: the triangles are halved by the median of their centres along the longest side
of their box until a leaf has eight or fewer. Many rays go down it together, level by level. Each
visits every leaf whose box it meets, as a bounding volume hierarchy without front-to-back order
does; the ray-triangle test is that of Moeller and Trumbore (1997), from both sides.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
_LEAF = 8  # triangles, at most
_RAYS = 2048  # that go down together: bounds the memory
_TINY = 1e-150  # replaces a zero component of a direction
_EDGE = 1e-9  # of a triangle's side: rays that meet a common edge do not slip through
_MARGIN = 1e-9  # of the mesh's size: boxes of triangles in one plane have some thickness


class TriangleTree:
    """Triangles for ray casts."""

    def __init__(self, triangles: Floats) -> None:
        """Build the tree; 20 000 triangles take 50 ms.

        Args:
            triangles: (n, 3, 3), corners in rows [m], n > 0.
        """
        depth = max(0, int(np.ceil(np.log2(len(triangles) / _LEAF))))
        order = _halved(triangles.mean(axis=1), depth)
        leaves = triangles[order]  # (leaves, in each, 3, 3)
        self._first = leaves[:, :, 0]
        self._side = leaves[:, :, 1] - self._first
        self._other = leaves[:, :, 2] - self._first
        margin = _MARGIN * float(np.ptp(triangles.reshape(-1, 3), axis=0).max())
        low, high = leaves.min(axis=(1, 2)) - margin, leaves.max(axis=(1, 2)) + margin
        self._levels = [(low, high)]  # the boxes of each level, the root first
        for _ in range(depth):
            low = low.reshape(-1, 2, 3).min(axis=1)
            high = high.reshape(-1, 2, 3).max(axis=1)
            self._levels.insert(0, (low, high))

    def distances(self, start: Floats, way: Floats) -> Floats:
        """Return the distances of the first hits [m], inf where nothing is hit.

        Args:
            start: (p, 3) [m].
            way: (p, 3) unit vectors.
        """
        found = [
            self._cast(start[i : i + _RAYS], way[i : i + _RAYS])
            for i in range(0, len(start), _RAYS)
        ]
        return np.concatenate([np.empty(0), *found])

    def _cast(self, start: Floats, way: Floats) -> Floats:
        inverse = 1.0 / np.where(np.abs(way) < _TINY, _TINY, way)
        ray, node = np.arange(len(start)), np.zeros(len(start), np.intp)
        for level, (low, high) in enumerate(self._levels):
            if level:
                ray, node = np.repeat(ray, 2), (2 * node[:, None] + (0, 1)).ravel()
            one, other = ((bound[node] - start[ray]) * inverse[ray] for bound in (low, high))
            enter = np.minimum(one, other).max(axis=1)
            leave = np.maximum(one, other).min(axis=1)
            met = (enter <= leave) & (leave >= 0.0)
            ray, node = ray[met], node[met]
        nearest = np.full(len(start), np.inf)
        np.minimum.at(nearest, ray, self._first_in_leaf(node, start[ray], way[ray]))
        return nearest

    def _first_in_leaf(self, leaf: NDArray[np.intp], start: Floats, way: Floats) -> Floats:
        """Return the distance of each ray's first hit in its leaf; inf for none."""
        side, other = self._side[leaf], self._other[leaf]
        ways = np.broadcast_to(way[:, None], side.shape)
        across = np.cross(ways, other)
        volume = (side * across).sum(axis=2)
        with np.errstate(divide='ignore', invalid='ignore'):  # parallel, or without area
            per = 1.0 / volume
            begin = start[:, None] - self._first[leaf]
            u = (begin * across).sum(axis=2) * per
            normal = np.cross(begin, side)
            v = (ways * normal).sum(axis=2) * per
            distance = (other * normal).sum(axis=2) * per
            inside = (u >= -_EDGE) & (v >= -_EDGE) & (u + v <= 1.0 + _EDGE) & (distance >= 0.0)
        nearest: Floats = np.where(inside, distance, np.inf).min(axis=1)
        return nearest


def _halved(centres: Floats, depth: int) -> NDArray[np.intp]:
    """Return the numbers of the triangles by leaves, (2 ** depth, in each); some occur twice."""
    order = np.arange(len(centres))[None]
    for _ in range(depth):
        if order.shape[1] % 2:
            order = np.concatenate([order, order[:, -1:]], axis=1)
        of_node = centres[order]
        longest = np.ptp(of_node, axis=1).argmax(axis=1)
        along = np.take_along_axis(of_node, longest[:, None, None], axis=2)[:, :, 0]
        sorted_along = np.argsort(along, axis=1, kind='stable')
        order = np.take_along_axis(order, sorted_along, axis=1).reshape(2 * len(order), -1)
    return order
