"""Converts a world to the scene of the rendering process."""

import math
import os
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core import Vector, rotate
from ..description import (
    DIRECTIONAL,
    POINT,
    SPOT,
    Box,
    Cylinder,
    LightSpec,
    Material,
    Mesh,
    Plane,
    Reflection,
    Sphere,
    Visual,
)
from ..meshes import read_mesh
from ..runtime import NOTHING, Link, World
from .gl import Appearance, Light, Scene, ScenePart
from .shapes import mesh_corners, unit_box, unit_cylinder, unit_sphere, unit_square

LIGHT_TYPES = {DIRECTIONAL: 0, POINT: 1, SPOT: 2}
Triangles = Callable[[], NDArray[Any]]


class SceneMirror:
    """Mirrors the visuals and lights of a world.

    `scene` and `meshes` are those of the last `update`; so are the poses that `poses` returns.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self._seen = NOTHING
        self._rows: dict[Link, int] = {}
        self._poses = np.empty((0, 7))
        self.scene = Scene(())
        self.meshes: dict[str, Triangles] = {}

    def update(self) -> bool:
        """Update `scene` from the world; return whether it has changed."""
        changes = self._world.revisions.since(self._seen)
        self._seen = changes.revision
        if changes.appearance:
            self._lay_out()
        for link, (position, orientation) in changes.moved.items():
            row = self._rows.get(link)
            if row is not None:
                self._poses[row] = *position, *orientation
        return changes.appearance

    def poses(self) -> NDArray[Any]:
        """Return the poses of the scene's bodies (n, 7): position [m], quaternion x, y, z, w."""
        return self._poses.copy()

    def _lay_out(self) -> None:
        world, self.meshes = self._world, {}
        links = [
            link
            for model in world.models.values()
            for link in model.links.values()
            if link.spec.visuals
        ]
        self._rows = {link: row for row, link in enumerate(links)}
        poses = (self._seen.poses[link] for link in links)
        numbers = [(*position, *orientation) for position, orientation in poses]
        self._poses = np.array(numbers, float).reshape(-1, 7)
        parts = tuple(
            part
            for link, row in self._rows.items()
            for visual in link.spec.visuals
            for part in visual_parts(visual, row, link.model.static, self.meshes)
        )
        scene = world.scene
        self.scene = Scene(
            parts,
            tuple(_light(light) for light in world.lights.values()),
            scene.ambient[:3],
            scene.background[:3],
            scene.shadows,
        )


def visual_parts(
    visual: Visual, body: int, still: bool, meshes: dict[str, Triangles]
) -> Iterator[ScenePart]:
    """Yield the surfaces of a visual, and add their triangles to `meshes`.

    Args:
        visual: of a body.
        body: its row in the poses.
        still: whether it seldom moves.
        meshes: triangles by key.
    """
    for key, triangles, size, appearance in _surfaces(visual):
        meshes[key] = triangles
        yield ScenePart(
            key,
            body,
            _matrix(visual, size).tobytes(),
            appearance,
            not isinstance(visual.geometry, Plane),
            still,
        )


def _surfaces(visual: Visual) -> Iterator[tuple[str, Triangles, Vector, Appearance]]:
    """Yield the surfaces of a visual: key and triangles, size, look."""
    material = visual.material or Material()
    appearance = _appearance(material.reflection, material.rgba[3])._replace(texture=material.image)
    match visual.geometry:
        case Box(size):
            yield 'box', unit_box, size, appearance
        case Sphere(radius):
            yield 'sphere', unit_sphere, (radius, radius, radius), appearance
        case Cylinder(radius, length):
            yield 'cylinder', unit_cylinder, (radius, radius, length), appearance
        case Plane(normal, (width, depth)):
            yield f'plane {normal}', lambda: unit_square(normal), (width, depth, 1.0), appearance
        case Mesh(path, scale):
            key = f'{path} {os.stat(path).st_mtime_ns}'
            for number, part in enumerate(read_mesh(path).parts):
                own = _appearance(part.reflection, part.rgba[3])._replace(texture=part.image)
                yield (
                    f'{key} {number}',
                    partial(mesh_corners, part.vertices, part.faces, part.normals, part.texcoords),
                    scale,
                    appearance if visual.material else own,
                )


def _appearance(own: Reflection, alpha: float) -> Appearance:
    return Appearance(
        own.ambient,
        own.diffuse,
        own.specular,
        own.shininess,
        own.emissive,
        alpha,
        own.lit,
        own.both_sides,
    )


def _light(light: LightSpec) -> Light:
    direction = rotate(light.pose.orientation, light.direction)
    length = math.hypot(*direction) or 1.0
    return Light(
        LIGHT_TYPES[light.type],
        light.pose.position,
        (direction[0] / length, direction[1] / length, direction[2] / length),
        light.diffuse[:3],
        light.specular[:3],
        light.range,
        (light.attenuation_constant, light.attenuation_linear, light.attenuation_quadratic),
        (
            math.cos(light.spot_inner_angle / 2.0),
            math.cos(light.spot_outer_angle / 2.0),
            light.spot_falloff,
        ),
        light.cast_shadows,
    )


def _matrix(visual: Visual, size: Vector) -> NDArray[Any]:
    """Return the transform (4, 4) from the unit shape to the link."""
    axes = [rotate(visual.pose.orientation, axis) for axis in np.eye(3)]
    matrix = np.eye(4)
    matrix[:3, :3] = np.array(axes).T * size
    matrix[:3, 3] = visual.pose.position
    return matrix
