"""Shapes as triangles with normals: counter-clockwise seen from outside, three corners each.

Arrays are (3 n, 8): position [m], normal, texture coordinates. Round shapes have as many segments
as Gazebo's, so that pictures have the same outlines.
"""

import math
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core import Vector

SEGMENTS = 32  # around cylinders and spheres, and from pole to pole


@cache
def unit_box() -> NDArray[Any]:
    """Return a cube of edge 1, with faces in Gazebo's drawing order, as transparency needs."""
    faces = []
    for axis, sign in ((1, -1), (1, 1), (2, 1), (0, -1), (2, -1), (0, 1)):
        normal = np.zeros(3)
        normal[axis] = sign
        right = np.roll(np.abs(normal), 1)
        up = np.cross(normal, right)
        faces += [
            [*(0.5 * (normal + u * right + v * up)), *normal, (u + 1) / 2, (v + 1) / 2]
            for u, v in _SQUARE
        ]
    return np.array(faces)


@cache
def unit_sphere() -> NDArray[Any]:
    """Return a sphere of radius 1; its poles are on the y axis, as Gazebo's are."""
    ring, segment = (
        numbers.ravel()
        for numbers in np.meshgrid(np.arange(SEGMENTS), np.arange(SEGMENTS), indexing='ij')
    )
    rings = np.stack([ring + 1, ring, ring, ring + 1, ring + 1, ring], axis=1)
    segments = np.stack([segment, segment + 1, segment, segment, segment + 1, segment + 1], axis=1)
    down, around = rings.ravel() * math.pi / SEGMENTS, segments.ravel() * 2 * math.pi / SEGMENTS
    points = np.stack(
        [np.sin(down) * np.sin(around), np.cos(down), np.sin(down) * np.cos(around)], axis=1
    )
    uv = np.stack([segments.ravel() / SEGMENTS, rings.ravel() / SEGMENTS], axis=1)
    return np.concatenate([points, points, uv], axis=1)


@cache
def unit_cylinder() -> NDArray[Any]:
    """Return a cylinder of radius 1 and length 1 about z."""
    corners = []
    for number in range(SEGMENTS):
        (x, y), (u, v) = (
            (math.cos(2.0 * math.pi * n / SEGMENTS), math.sin(2.0 * math.pi * n / SEGMENTS))
            for n in (number, number + 1)
        )
        a, b = number / SEGMENTS, (number + 1) / SEGMENTS
        side = [
            (x, y, -0.5, x, y, 0.0, a, 0.0),
            (u, v, -0.5, u, v, 0.0, b, 0.0),
            (u, v, 0.5, u, v, 0.0, b, 1.0),
            (x, y, 0.5, x, y, 0.0, a, 1.0),
        ]
        corners += [side[n] for n in (0, 1, 2, 0, 2, 3)]
        for z, ends in ((0.5, ((x, y), (u, v))), (-0.5, ((u, v), (x, y)))):
            corners += [
                (*point, z, 0.0, 0.0, 2.0 * z, 0.5 + point[0] / 2, 0.5 + point[1] / 2)
                for point in ((0.0, 0.0), *ends)
            ]
    return np.array(corners)


@cache
def unit_square(normal: Vector) -> NDArray[Any]:
    """Return a square of edge 1 at the origin, facing along `normal`."""
    upward = np.array(normal)
    right = np.cross((0.0, 1.0, 0.0) if abs(upward[1]) < 0.9 else (0.0, 0.0, 1.0), upward)
    right /= np.linalg.norm(right)
    ahead = np.cross(upward, right)
    return np.array(
        [[*(0.5 * (u * right + v * ahead)), *upward, (u + 1) / 2, (v + 1) / 2] for u, v in _SQUARE]
    )


def mesh_corners(
    vertices: NDArray[Any],
    faces: NDArray[Any],
    normals: NDArray[Any] | None,
    texcoords: NDArray[Any] | None = None,
) -> NDArray[Any]:
    """Return the triangles of a mesh, flat-shaded if it has no normals.

    Args:
        vertices: (n, 3) [m].
        faces: (m, 3), indices of vertices.
        normals: (n, 3), at the vertices.
        texcoords: (n, 2), at the vertices.
    """
    corners = vertices[faces].reshape(-1, 3)
    if normals is None:
        sides = corners.reshape(-1, 3, 3)
        flat = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
        length = np.linalg.norm(flat, axis=1, keepdims=True)
        flat = np.divide(flat, length, out=np.zeros_like(flat), where=length > 0.0)
        turned = np.repeat(flat, 3, axis=0)
    else:
        turned = normals[faces].reshape(-1, 3)
    uv = np.zeros((len(corners), 2)) if texcoords is None else texcoords[faces].reshape(-1, 2)
    return np.concatenate([corners, turned, uv], axis=1)


_SQUARE = ((-1, -1), (1, -1), (1, 1), (-1, -1), (1, 1), (-1, 1))
