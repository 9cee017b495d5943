"""An offscreen camera: images of the world on machines without a display."""

import math
from collections.abc import Iterator

import numpy as np

from ..core import Vector, compose
from ..core.arrays import ByteArray
from ..description import Box, Colour, Cylinder, Material, Mesh, Plane, Sphere, Visual
from ..meshes import visual_parts
from ..runtime import Link, Model, World
from .canvas import Canvas, Triangles

EYE: Vector = (1.9, -1.9, 1.3)  # [m] for a view of a robot at the origin
TARGET: Vector = (0.0, 0.1, 0.25)  # [m]
SIZE = (640, 480)  # pixels
FIELD_OF_VIEW = math.radians(45.0)
GROUND_SHOWN = 20.0  # [m] edge of the drawn part of an infinite plane
_TILE = 0.5  # [m] edge of its tiles


class View:
    """Images of a world in its current state.

    Free until the first image; an image of the article's robot takes about 0.1 s.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self._canvas: Canvas | None = None
        self._shown: dict[str, tuple[Model, list[tuple[Link, Visual, list[int]]]]] = {}

    def close(self) -> None:
        """Free all resources."""
        if self._canvas is not None:
            self._canvas.close()
        self._canvas = None
        self._shown.clear()

    def picture(
        self,
        eye: Vector = EYE,
        target: Vector = TARGET,
        size: tuple[int, int] = SIZE,
        field_of_view: float = FIELD_OF_VIEW,
    ) -> ByteArray:
        """Return the view from `eye` towards `target` [m, world], (height, width, 3) RGB bytes.

        Args:
            size: width and height in pixels.
            field_of_view: vertical [rad].
        """
        if self._canvas is None:
            self._canvas = Canvas()
        self._follow_world(self._canvas)
        for _, parts in self._shown.values():
            for link, visual, numbers in parts:
                pose = compose(link.pose, visual.pose)
                for number in numbers:
                    self._canvas.place(number, pose)
        return self._canvas.picture(size, eye, target, field_of_view)

    def _follow_world(self, canvas: Canvas) -> None:
        """Remove deleted models and add new ones."""
        for name, (model, parts) in list(self._shown.items()):
            if self._world.models.get(name) is not model:
                for _, _, numbers in parts:
                    for number in numbers:
                        canvas.remove(number)
                del self._shown[name]
        for name, model in self._world.models.items():
            if name not in self._shown:
                self._shown[name] = (
                    model,
                    [
                        (link, visual, [canvas.add(*part) for part in _parts(visual)])
                        for link in model.links.values()
                        for visual in link.spec.visuals
                    ],
                )


def _parts(visual: Visual) -> list[tuple[Triangles | Box | Sphere | Cylinder, Colour]]:
    """Return the shapes of a visual; a mesh without a material has one for each of its colours."""
    geometry, rgba = visual.geometry, (visual.material or Material()).rgba
    if isinstance(geometry, Mesh):
        return [
            (Triangles(vertices * np.asarray(geometry.scale), faces),
             visual.material.rgba if visual.material else own)
            for vertices, faces, _, own in visual_parts(geometry.path)
        ]
    return list(_tiles(rgba)) if isinstance(geometry, Plane) else [(geometry, rgba)]


def _tiles(rgba: Colour) -> Iterator[tuple[Triangles, Colour]]:
    """Yield a chequered square of ground, so that pictures show distances."""
    count = round(GROUND_SHOWN / _TILE)
    corners = (np.arange(count) - count / 2) * _TILE
    x, y = (axis.ravel() for axis in np.meshgrid(corners, corners))
    dark = (np.add.outer(np.arange(count), np.arange(count)) % 2 == 0).ravel()
    for chosen, brightness in ((dark, 1.25), (~dark, 1.45)):
        corner = np.stack([x[chosen], y[chosen], np.zeros(chosen.sum())], axis=1)
        square = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]) * _TILE
        vertices = (corner[:, None, :] + square).reshape(-1, 3)
        first = np.arange(len(corner))[:, None, None] * 4
        faces = (first + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3)
        red, green, blue = (min(1.0, value * brightness) for value in rgba[:3])
        yield Triangles(vertices, faces), (red, green, blue, rgba[3])
