"""Where a new model has room: on the ground, beside what is there."""

import contextlib
import math
from collections.abc import Iterable, Iterator

import numpy as np

from ...sim.core import ModelError, Pose, compose
from ...sim.core.arrays import FloatArray
from ...sim.description import LinkSpec, ModelSpec
from ...sim.meshes import extent
from ...sim.runtime import World

GAP = 0.05  # [m] between models, horizontally
DEPTH = 1e-3  # [m] vertically, up to which boxes touch
RINGS = 12  # of places that are tried, each a model's width wider than the one within


def placed(
    world: World, spec: ModelSpec, pose: Pose, on_ground: bool, beside: bool
) -> Pose:
    """Return where a model is to be spawned, by the boxes around its shapes and those of others.

    Args:
        pose: of the model, in the world.
        on_ground: let the lowest point of the model be at the height of `pose`.
        beside: choose the nearest place that is free, or one on top of what is at `pose`.
    """
    boxes = _boxes((link, compose(pose, link.pose)) for link in spec.links)
    if not len(boxes):
        return pose
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    shift = np.zeros(3)
    if on_ground:
        shift[2] = pose.position[2] - low[2]
    if beside:
        shift += _way(low + shift, high + shift, _others(world))
    x, y, z = np.add(pose.position, shift).tolist()
    return Pose((x, y, z), pose.orientation)


def _way(low: FloatArray, high: FloatArray, others: FloatArray) -> FloatArray:
    """Return the shortest way on which a box comes free of others (n, 2, 3) [m]."""
    width = max(*(high - low)[:2], GAP)
    for way in _ways(width + GAP):
        met = _met(low + way, high + way, others)
        if not met.any():
            return way
    tops = others[_met(low, high, others), 1, 2]
    return np.array([0.0, 0.0, tops.max() - low[2]])


def _met(low: FloatArray, high: FloatArray, others: FloatArray) -> FloatArray:
    """Tell which boxes another one meets."""
    gap = np.array([GAP, GAP, -DEPTH])
    met: FloatArray = ((low - gap < others[:, 1]) & (high + gap > others[:, 0])).all(axis=1)
    return met


def _ways(width: float) -> Iterator[FloatArray]:
    """Yield ways on the ground, the short ones first [m]."""
    yield np.zeros(3)
    for ring in range(1, RINGS + 1):
        for angle in np.arange(8 * ring) * (math.tau / (8 * ring)):
            yield ring * width * np.array([math.cos(angle), math.sin(angle), 0.0])


def _others(world: World) -> FloatArray:
    """Return the boxes around all shapes in the world (n, 2, 3) [m]."""
    return _boxes((link.spec, link.pose) for model in world.models.values()
                  for link in model.links.values())


def _boxes(links: Iterable[tuple[LinkSpec, Pose]]) -> FloatArray:
    """Return boxes around the shapes of links at these poses (n, 2, 3) [m]."""
    found = []
    for link, pose in links:
        for shape in link.collisions or link.visuals:
            with contextlib.suppress(ModelError):  # a mesh that has gone
                box = extent(shape.geometry, compose(pose, shape.pose))
                if box is not None:
                    found.append(box)
    return np.reshape(found, (-1, 2, 3))
