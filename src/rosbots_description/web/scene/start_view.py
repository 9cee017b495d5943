"""Where the page begins to look from: what the world says, or where most is seen from."""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ...sim.core import Pose, Vector, add, as_vector, dot, rotate, subtract
from ...sim.description import SceneChange, SceneSpec
from ..controls import Panel
from .bounds import corners
from .models import Models

FORWARD = (1.0, 0.0, 0.0)  # of the camera of a world
DISTANCE = 0.95  # of the eye, in diagonals of all there is
NEAREST = 1.0  # [m]
FIRST = math.radians(-43.0)  # azimuth of the eye that is tried first: ahead, at the right
ELEVATIONS = tuple(map(math.radians, (25.0, 40.0, 60.0, 80.0)))
AROUND = 8  # azimuths at each
ENOUGH = 0.95  # of what is seen from the best place
MOST = 200  # shapes that are looked for, and that may hide others
Points = NDArray[np.float64]
Placed = tuple[str, Points]  # model, and eight corners in the world [m]


class StartView(Panel):
    """Chooses the view for those who come."""

    def __init__(self, models: Models) -> None:
        self._models = models
        self._scene = SceneSpec()
        self._chosen: tuple[Vector, Vector] | None = None
        self._for: frozenset[str] = frozenset()  # the models for which it is chosen

    def apply(self, change: SceneChange) -> None:
        """Take in the view that the world asks for."""
        if change.scene.user_camera != self._scene.user_camera:
            self._chosen = None
        self._scene = change.scene

    def choose(self, aspect: float = 1.0) -> tuple[Vector, Vector]:
        """Return eye and target [m], the same ones until a model comes or goes.

        Grounds and other planes are not looked at.

        Args:
            aspect: width of the picture by its height; the eye is further away if it is narrow.
        """
        names = frozenset(self._models.all)
        if self._chosen is None or names != self._for:
            self._chosen, self._for = self._best(), names
        eye, target = self._chosen
        if self._scene.user_camera is not None or aspect >= 1.0:
            return eye, target
        return add(target, as_vector(part / aspect for part in subtract(eye, target))), target

    def _best(self) -> tuple[Vector, Vector]:
        boxes = list(self._boxes())
        points = np.concatenate([box for _, box in boxes] or [np.array([[-1.0] * 3, [1.0] * 3])])
        low, high = points.min(axis=0), points.max(axis=0)
        middle = as_vector((low + high) / 2.0)
        camera = self._scene.user_camera
        if camera is not None:
            return camera.position, _target(camera, middle)
        distance = max(DISTANCE * float(np.linalg.norm(high - low)), NEAREST)
        return _best(boxes, middle, distance), middle

    def _boxes(self) -> Iterator[Placed]:
        for name, model in self._models.all.items():
            for link in model.links:
                pose = self._models.link_pose(link)
                for visual in link.visuals:
                    places = corners([visual], pose)
                    if places:
                        yield name, np.array(places)


def _target(camera: Pose, middle: Vector) -> Vector:
    """Return the point ahead of a camera that is as far as the middle of everything."""
    ahead = rotate(camera.orientation, FORWARD)
    far = max(dot(ahead, subtract(middle, camera.position)), NEAREST)
    return add(camera.position, as_vector(far * part for part in ahead))


def _best(boxes: list[Placed], middle: Vector, distance: float) -> Vector:
    """Return the first eye from which nearly as much is seen as from any other."""
    eyes = [
        as_vector(
            np.add(
                middle,
                distance
                * np.array(
                    [
                        math.cos(elevation) * math.cos(azimuth),
                        math.cos(elevation) * math.sin(azimuth),
                        math.sin(elevation),
                    ]
                ),
            )
        )
        for elevation in ELEVATIONS
        for azimuth in FIRST + np.arange(AROUND) * 2.0 * math.pi / AROUND
    ]
    seen = []
    for eye in eyes:
        seen.append(_seen(boxes, np.array(eye)))
        if seen[-1] >= ENOUGH:
            return eye
    return next(eye for eye, share in zip(eyes, seen, strict=True) if share >= ENOUGH * max(seen))


def _seen(boxes: list[Placed], eye: Points) -> float:
    """Return the share of boxes whose middle no box of another model hides."""
    if not boxes:
        return 1.0
    shown = boxes[:: -(-len(boxes) // MOST)]
    large = sorted(boxes, key=lambda box: -float(np.ptp(box[1], axis=0).prod()))[:MOST]
    names, corner = np.array([name for name, _ in large]), np.array([box for _, box in large])
    edges = corner[:, (4, 2, 1)] - corner[:, :1]  # from the lowest corner along x, y, z
    lengths = np.maximum(np.square(edges).sum(-1), 1e-12)
    hidden = 0
    for name, box in shown:
        # Along each edge, the eye and the way from it to the box; 0 to 1 is within the hiding one.
        start = ((eye - corner[:, 0])[:, None] * edges).sum(-1) / lengths
        way = ((box.mean(axis=0) - eye) * edges).sum(-1) / lengths
        way = np.where(np.abs(way) < 1e-9, 1e-9, way)
        ends = np.stack([-start / way, (1.0 - start) / way])
        enters, leaves = ends.min(axis=0).max(-1), ends.max(axis=0).min(-1)
        crossed = (enters < np.minimum(leaves, 1.0)) & (leaves > 0.0)
        hidden += bool(np.any(crossed & (names != name)))
    return 1.0 - hidden / len(shown)
