"""Where a new model has room: on the ground, beside what is there."""

import contextlib
import math
import re
from collections.abc import Callable, Iterable, Iterator
from itertools import count

import numpy as np
from numpy.typing import NDArray

from ..core import ModelError, Pose, compose
from ..core.arrays import FloatArray
from ..description import Geometry, LinkSpec, Mesh, ModelSpec
from ..meshes import extent, rough_extent
from ..runtime import World

BoolArray = NDArray[np.bool_]

GAP = 0.05  # [m] between models, horizontally
DEPTH = 1e-3  # [m] vertically, up to which boxes touch
_NUMBER = re.compile(r'_\d+$')
RINGS = 12  # of places that are tried, each a model's width wider than the one within


def box_around(spec: ModelSpec, pose: Pose) -> FloatArray | None:
    """Return the lowest and the highest corner (2, 3) of the box around a model [m].

    Its joints are at zero. It may take long, as meshes are read. None for what has no end.

    Args:
        pose: of the model, in the world.
    """
    boxes = [
        box for _, box in _boxes(((link, compose(pose, link.pose)) for link in spec.links), extent)
    ]
    if not boxes:
        return None
    return np.array([np.min(boxes, axis=0)[0], np.max(boxes, axis=0)[1]])


def placed(world: World, pose: Pose, box: FloatArray, on_ground: bool, beside: bool) -> Pose:
    """Return where a model is to be spawned.

    Args:
        pose: of the model, in the world.
        box: around the model at this pose, see `box_around`.
        on_ground: let the lowest point of the model be at the height of `pose`.
        beside: choose the nearest place that is free, or one on top of what is at `pose`.
    """
    shift = np.zeros(3)
    if on_ground:
        shift[2] = pose.position[2] - box[0, 2]
    if beside:
        shift += _Obstacles(world).way_around(box + shift)
    x, y, z = np.add(pose.position, shift).tolist()
    return Pose((x, y, z), pose.orientation)


def free_name(world: World, name: str) -> str:
    """Return the name, with another number at its end if a model or light has it."""
    taken = world.models.keys() | world.lights.keys()
    if name not in taken:
        return name
    stem = _NUMBER.sub('', name)
    return next(other for n in count() if (other := f'{stem}_{n}') not in taken)


class _Obstacles:
    """Boxes around all shapes in the world."""

    def __init__(self, world: World) -> None:
        found = list(
            _boxes(
                (
                    (link.spec, link.pose)
                    for model in world.models.values()
                    for link in model.links.values()
                ),
                rough_extent,
            )
        )
        self._boxes = np.reshape([box for _, box in found], (-1, 2, 3))
        # Within the box around a mesh there may be room, as in a building.
        self._hollow = np.array([isinstance(shape, Mesh) for shape, _ in found], bool)

    def way_around(self, box: FloatArray) -> FloatArray:
        """Return the shortest way on which a box (2, 3) comes free, up if there is no other [m]."""
        width = max(*(box[1] - box[0])[:2], GAP)
        for way in _ways(width + GAP):
            if not self._met(box + way).any():
                return way
        top = self._boxes[self._met(box), 1, 2].max()
        return np.array([0.0, 0.0, top - box[0, 2]])

    def _met(self, box: FloatArray) -> BoolArray:
        """Tell which boxes another one meets (n)."""
        low, high = box
        gap = np.array([GAP, GAP, -DEPTH])
        met = (low - gap < self._boxes[:, 1]) & (high + gap > self._boxes[:, 0])
        within = (low + DEPTH > self._boxes[:, 0]) & (high < self._boxes[:, 1])
        return np.asarray(met.all(axis=1) & ~(self._hollow & within.all(axis=1)))


def _ways(width: float) -> Iterator[FloatArray]:
    """Yield ways on the ground, the short ones first [m]."""
    yield np.zeros(3)
    for ring in range(1, RINGS + 1):
        for angle in np.arange(8 * ring) * (math.tau / (8 * ring)):
            yield ring * width * np.array([math.cos(angle), math.sin(angle), 0.0])


def _boxes(
    links: Iterable[tuple[LinkSpec, Pose]], around: Callable[[Geometry, Pose], FloatArray | None]
) -> Iterator[tuple[Geometry, FloatArray]]:
    """Yield the shapes of links at these poses, with boxes around them (2, 3) [m]."""
    for link, pose in links:
        for shape in link.collisions or link.visuals:
            with contextlib.suppress(ModelError):  # a mesh that has gone
                box = around(shape.geometry, compose(pose, shape.pose))
                if box is not None:
                    yield shape.geometry, box
