"""Pictures of a world for people: soft shadows, a grid on the ground, and figures such as a goal.

Cameras of robots see what Gazebo's cameras see, where shadows of a grey ground are almost black.
Here, the sky scatters part of the sun's light into them, as on the page in the browser.
"""

from collections.abc import Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core import UP, Pose, Vector, add
from ..description import DIRECTIONAL, Plane, Visual
from ..runtime import World
from .camera import OVERVIEW
from .gl import Appearance, Scene, ScenePart, Wants
from .image_capture import ImageCapture, SceneRenderer
from .scene import LIGHT_TYPES, SceneMirror, Triangles, visual_parts

_SUN, _SKY = 0.6, 0.3  # shares of a sun's light: what is left of it, and what becomes ambient light
_GRID = 'grid'
_GRID_HEIGHT = 0.004  # [m] above the ground
_GRID_REACH = 20  # [m] lines on each side
_LINE = 0.015  # [m] width
_GRID_LOOK = Appearance((0.0,) * 3, (0.0,) * 3, alpha=0.25)
_IDENTITY = np.eye(4).tobytes()


class Figure(NamedTuple):
    """What pictures show besides the world: a visual at a pose in the world.

    The view has room for those that are `in_view`.
    """

    visual: Visual
    pose: Pose = Pose()
    in_view: bool = True


class IllustratedScene:
    """A `SceneMirror` of a world with figures, a grid on its ground, and softened light."""

    def __init__(self, world: World) -> None:
        self._world, self._mirror = world, SceneMirror(world)
        self.figures: Sequence[Figure] = ()
        self.middle: Vector = (0.0, 0.0, 0.0)  # [m] of the grid
        self._shown: tuple[Visual, ...] = ()
        self._ground: float | None = None  # [m] its height
        self.scene = Scene(())
        self.meshes: dict[str, Triangles] = {}

    def update(self) -> bool:
        """Update `scene` from world and figures; return whether it has changed."""
        shown = tuple(figure.visual for figure in self.figures)
        changed = self._mirror.update()
        if not changed and shown == self._shown:
            return False
        self._shown, self._ground = shown, self._find_ground()
        scene = self._mirror.scene
        self.meshes = {**self._mirror.meshes, _GRID: _grid}
        bodies = len(self._mirror.poses())
        parts = [
            part._replace(appearance=part.appearance._replace(ambient=part.appearance.diffuse))
            for part in scene.parts
        ]
        for number, visual in enumerate(shown):
            parts += [
                part._replace(casts_shadow=False)
                for part in visual_parts(visual, bodies + number, False, self.meshes)
            ]
        if self._ground is not None:
            parts.append(ScenePart(_GRID, bodies + len(shown), _IDENTITY, _GRID_LOOK, False))
        self.scene = _softened(scene)._replace(parts=tuple(parts))
        return True

    def poses(self) -> NDArray[Any]:
        """Return the poses of the scene's bodies (n, 7)."""
        x, y, _ = self.middle
        grid = (round(x), round(y), (self._ground or 0.0) + _GRID_HEIGHT, 0.0, 0.0, 0.0, 1.0)
        figures = [(*figure.pose.position, *figure.pose.orientation) for figure in self.figures]
        return np.concatenate([self._mirror.poses(), [*figures, grid]])

    def _find_ground(self) -> float | None:
        """Return the height of the first plane that faces up [m], or None."""
        return next(
            (
                link.pose.position[2] + visual.pose.position[2]
                for model in self._world.models.values()
                for link in model.links.values()
                for visual in link.spec.visuals
                if isinstance(visual.geometry, Plane) and visual.geometry.normal == UP
            ),
            None,
        )


class Illustrator:
    """Takes pictures for people by a process of its own, which starts with the first of them."""

    def __init__(self, world: World) -> None:
        self._scene = IllustratedScene(world)
        self._capture = ImageCapture(world, SceneRenderer(world, self._scene))

    def take(self, eye: Pose, middle: Vector, figures: Sequence[Figure]) -> NDArray[np.uint8]:
        """Return a picture (height, width, 3) of the world as it is now.

        Args:
            eye: of the camera, which looks along its x axis.
            middle: of the grid [m], rounded to metres.
            figures: what to show besides the world.
        Raises:
            RenderError: nothing can be drawn on this machine.
        """
        self._scene.figures, self._scene.middle = figures, middle
        self._capture.request([(OVERVIEW, eye)], 0, Wants())
        taken = self._capture.receive_image(wait=True)
        return np.array(taken[0].pixels if taken else None)


def _softened(scene: Scene) -> Scene:
    """Return a scene in which suns are weaker, and what they lack is ambient light."""
    sun = LIGHT_TYPES[DIRECTIONAL]
    suns = [light.diffuse for light in scene.lights if light.type == sun]
    lights = tuple(
        light._replace(diffuse=_dimmed(light.diffuse, _SUN)) if light.type == sun else light
        for light in scene.lights
    )
    ambient = scene.ambient
    for diffuse in suns:
        ambient = add(ambient, _dimmed(diffuse, _SKY))
    return scene._replace(lights=lights, ambient=ambient, soft=True)


def _dimmed(colour: Vector, share: float) -> Vector:
    red, green, blue = colour
    return share * red, share * green, share * blue


@cache
def _grid() -> NDArray[Any]:
    """Return the triangles of lines 1 m apart (n, 8), in the plane z = 0 and facing up."""
    corners = []
    for number in range(-_GRID_REACH, _GRID_REACH + 1):
        for across in (False, True):
            low, high = number - _LINE / 2.0, number + _LINE / 2.0
            quad: list[tuple[float, float]] = [
                (low, -_GRID_REACH),
                (high, -_GRID_REACH),
                (high, _GRID_REACH),
                (low, _GRID_REACH),
            ]
            if across:
                quad = [(y, x) for x, y in reversed(quad)]
            corners += [(*quad[n], 0.0, *UP, 0.0, 0.0) for n in (0, 1, 2, 0, 2, 3)]
    return np.array(corners)
