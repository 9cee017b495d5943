"""Software rendering: visual shapes and a camera."""

import math
from dataclasses import dataclass

import numpy as np

from ..core import Pose, Vector
from ..core.arrays import ByteArray, FloatArray, IntArray
from ..description import Box, Colour, Cylinder, Sphere
from ..physics.bullet import pybullet

_SUN = (2.0, -1.0, 4.0)  # direction towards the light, world axes


@dataclass(frozen=True)
class Triangles:
    """A surface: vertices (n, 3) [m], and faces (m, 3), indices of vertices."""

    vertices: FloatArray
    faces: IntArray


class Canvas:
    """Visual shapes in a PyBullet world of their own, and a camera.

    It renders in software, so it needs neither a display nor a graphics card.
    """

    def __init__(self) -> None:
        self._client = pybullet.connect(pybullet.DIRECT)

    def close(self) -> None:
        """Free the canvas."""
        pybullet.disconnect(self._client)

    def add(self, shape: Triangles | Box | Sphere | Cylinder, rgba: Colour) -> int:
        """Add a shape; return its number, for `place` and `remove`."""
        match shape:
            case Triangles(vertices, faces):
                kind = pybullet.GEOM_MESH
                form = {'vertices': vertices.tolist(), 'indices': faces.ravel().tolist()}
            case Box(size):
                kind, form = pybullet.GEOM_BOX, {'halfExtents': [edge / 2.0 for edge in size]}
            case Sphere(radius):
                kind, form = pybullet.GEOM_SPHERE, {'radius': radius}
            case Cylinder(radius, length):
                kind, form = pybullet.GEOM_CYLINDER, {'radius': radius, 'length': length}
        visual = pybullet.createVisualShape(
            kind, rgbaColor=rgba, physicsClientId=self._client, **form)
        number: int = pybullet.createMultiBody(
            baseVisualShapeIndex=visual, physicsClientId=self._client)
        return number

    def remove(self, number: int) -> None:
        """Remove a shape."""
        pybullet.removeBody(number, self._client)

    def place(self, number: int, pose: Pose) -> None:
        """Move a shape."""
        pybullet.resetBasePositionAndOrientation(number, *pose, self._client)

    def picture(
        self, size: tuple[int, int], eye: Vector, target: Vector, field_of_view: float
    ) -> ByteArray:
        """Return the view from `eye` towards `target` [m], z up: (height, width, 3) RGB bytes.

        Args:
            size: width and height in pixels.
            field_of_view: vertical [rad].
        """
        width, height = size
        near, far = 0.05, 100.0  # [m]
        view = pybullet.computeViewMatrix(eye, target, (0.0, 0.0, 1.0))
        projection = pybullet.computeProjectionMatrixFOV(
            math.degrees(field_of_view), width / height, near, far
        )
        pixels = pybullet.getCameraImage(
            width,
            height,
            view,
            projection,
            lightDirection=_SUN,
            shadow=0,  # shadows take six times as long as the rest
            renderer=pybullet.ER_TINY_RENDERER,
            flags=pybullet.ER_NO_SEGMENTATION_MASK,
            physicsClientId=self._client,
        )[2]
        return np.reshape(pixels, (height, width, 4))[:, :, :3].astype(np.uint8)
