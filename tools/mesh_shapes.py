"""Build closed triangle surfaces from a few dimensions.

A surface is an array of shape (triangles, corners = 3, coordinates = 3), counter-clockwise seen
from outside. An outline is an array of shape (points, 2), counter-clockwise; a loop is one of shape
(points, 3). Lengths are in whatever unit the caller uses; angles are in radians.
"""

import itertools
import math
from collections import defaultdict
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Surface = Array

CREASE = math.radians(38.0)  # faces at a greater angle keep a sharp edge


def circle(radius: float, points: int, centre: Sequence[float] = (0.0, 0.0)) -> Array:
    """Return the outline of a regular polygon whose first corner lies on the first axis."""
    angles = 2.0 * math.pi * np.arange(points) / points
    outline: Array = np.column_stack([np.cos(angles), np.sin(angles)]) * radius + np.asarray(centre)
    return outline


def rectangle(
    low: Sequence[float], high: Sequence[float], corner: float = 0.0, steps: int = 3
) -> Array:
    """Return the outline of a rectangle, its corners rounded with radius `corner`."""
    (left, bottom), (right, top) = low, high
    if corner == 0.0:
        return np.array([[left, bottom], [right, bottom], [right, top], [left, top]], float)
    arc = np.linspace(0.0, math.pi / 2.0, steps + 1)
    centres = [
        (right - corner, top - corner),
        (left + corner, top - corner),
        (left + corner, bottom + corner),
        (right - corner, bottom + corner),
    ]
    points = [
        (
            x + corner * math.cos(turn * math.pi / 2.0 + angle),
            y + corner * math.sin(turn * math.pi / 2.0 + angle),
        )
        for turn, (x, y) in enumerate(centres)
        for angle in arc
    ]
    return np.array(points)


def inset(outline: Array, distance: float) -> Array:
    """Return a convex outline moved inwards by `distance`, edges staying parallel to themselves."""
    edges = np.roll(outline, -1, axis=0) - outline
    inward = np.column_stack([-edges[:, 1], edges[:, 0]])
    inward /= np.linalg.norm(inward, axis=1, keepdims=True)
    before = np.roll(inward, 1, axis=0)
    cosine = np.sum(before * inward, axis=1, keepdims=True)
    moved_by: Array = distance * (before + inward) / (1.0 + cosine)
    return outline + moved_by


def at_height(outline: Array, height: float) -> Array:
    """Return the loop that lies above an outline at `height` along the third axis."""
    return np.column_stack([outline, np.full(len(outline), height)])


def bridge(lower: Array, upper: Array) -> Surface:
    """Return the band between two loops of equally many points; `upper` by the right-hand rule."""
    next_lower, next_upper = np.roll(lower, -1, axis=0), np.roll(upper, -1, axis=0)
    return np.concatenate(
        [
            np.stack([lower, next_lower, next_upper], axis=1),
            np.stack([lower, next_upper, upper], axis=1),
        ]
    )


def cap(loop: Array) -> Surface:
    """Return the fan that closes a flat convex loop."""
    return np.stack([np.stack([loop[0], loop[i], loop[i + 1]]) for i in range(1, len(loop) - 1)])


def loft(loops: Sequence[Array]) -> Surface:
    """Return the solid through loops of equally many points, first to last, closed at both ends."""
    bands = [bridge(lower, upper) for lower, upper in itertools.pairwise(loops)]
    return np.concatenate([cap(loops[0][::-1]), *bands, cap(loops[-1])])


def ring(loops: Sequence[Array]) -> Surface:
    """Return the ring-shaped solid whose last loop joins its first, outer loops upwards first."""
    return np.concatenate(
        [bridge(lower, upper) for lower, upper in zip(loops, [*loops[1:], loops[0]], strict=True)]
    )


def prism(outline: Array, bottom: float, top: float, bevel: float = 0.0) -> Surface:
    """Return an outline extruded along the third axis, both rims broken by a 45 degree bevel."""
    if bevel == 0.0:
        return loft([at_height(outline, bottom), at_height(outline, top)])
    small = inset(outline, bevel)
    return loft(
        [
            at_height(small, bottom),
            at_height(outline, bottom + bevel),
            at_height(outline, top - bevel),
            at_height(small, top),
        ]
    )


def block(low: Sequence[float], high: Sequence[float], bevel: float = 0.0) -> Surface:
    """Return a box from corner `low` to corner `high`."""
    return prism(rectangle(low[:2], high[:2]), low[2], high[2], bevel)


def lathe(profile: Sequence[tuple[float, float]], segments: int) -> Surface:
    """Return the solid of revolution of a closed (radius, height) profile about the third axis."""
    return ring([at_height(circle(radius, segments), height) for radius, height in profile])


def perforated(
    columns: Sequence[float],
    rows: Sequence[float],
    bottom: float,
    top: float,
    *,
    holes: Sequence[tuple[int, int]],
    radius: float,
) -> Surface:
    """Return a plate cut into cells by grid lines; the (column, row) of `holes` get a round one."""
    faces = []
    for column in range(len(columns) - 1):
        for row in range(len(rows) - 1):
            low, high = (columns[column], rows[row]), (columns[column + 1], rows[row + 1])
            corners = rectangle(low, high)
            if (column, row) in holes:
                faces.append(_cell_with_hole(corners, radius, bottom, top))
            else:
                faces += [cap(at_height(corners, top)), cap(at_height(corners, bottom)[::-1])]
    rim = np.array(
        [(x, rows[0]) for x in columns[:-1]]
        + [(columns[-1], y) for y in rows[:-1]]
        + [(x, rows[-1]) for x in columns[:0:-1]]
        + [(columns[0], y) for y in rows[:0:-1]]
    )
    faces.append(bridge(at_height(rim, bottom), at_height(rim, top)))
    return np.concatenate(faces)


def _cell_with_hole(corners: Array, radius: float, bottom: float, top: float) -> Surface:
    """Return both faces of a rectangular cell round an octagonal hole, and the hole's wall."""
    # The octagon starts at its lower left corner: each cell corner then faces two of its points.
    octagon = np.roll(circle(radius, 8, corners.mean(axis=0)), 3, axis=0)
    triangles = []
    for i, corner in enumerate(corners):
        here, there, beyond = octagon[2 * i], octagon[2 * i + 1], octagon[(2 * i + 2) % 8]
        triangles += [
            (corner, there, here),
            (corner, corners[(i + 1) % 4], there),
            (corners[(i + 1) % 4], beyond, there),
        ]
    face = np.array(triangles)
    lift = [np.dstack([face, np.full(face.shape[:2], height)]) for height in (bottom, top)]
    wall = bridge(at_height(octagon[::-1], bottom), at_height(octagon[::-1], top))
    return np.concatenate([lift[0][:, ::-1], lift[1], wall])


def along_first_axis(surface: Surface) -> Surface:
    """Rotate a surface: axis 3 becomes axis 1, axis 1 becomes 2, and 2 becomes 3."""
    rotated: Surface = surface[:, :, [2, 0, 1]]
    return rotated


def moved(surface: Surface, offset: Sequence[float]) -> Surface:
    """Return a surface shifted by `offset`."""
    shifted: Surface = surface + np.asarray(offset, float)
    return shifted


def turned(surface: Surface, angle: float) -> Surface:
    """Return a surface rotated about the third axis by `angle`, counter-clockwise."""
    cosine, sine = math.cos(angle), math.sin(angle)
    rotated: Surface = surface @ np.array(
        [[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]]
    )
    return rotated


def corner_normals(surface: Surface) -> Array:
    """Return a unit normal for each corner, shaped as the surface: smooth, but sharp at creases.

    A corner's normal is the mean of the faces that share its point, weighted by area, leaving out
    those at an angle above `CREASE` to its own face.
    """
    area = np.cross(surface[:, 1] - surface[:, 0], surface[:, 2] - surface[:, 0])
    unit = area / np.linalg.norm(area, axis=1, keepdims=True)
    sharing = defaultdict(list)
    keys = [[tuple(point) for point in face] for face in np.round(surface, 9).tolist()]
    for face, points in enumerate(keys):
        for point in points:
            sharing[point].append(face)
    normals = np.empty_like(surface)
    for face, points in enumerate(keys):
        for corner, point in enumerate(points):
            near = [
                other for other in sharing[point] if unit[face] @ unit[other] > math.cos(CREASE)
            ]
            total = area[near].sum(axis=0)
            normals[face, corner] = total / np.linalg.norm(total)
    return normals
