"""Sunlight on what stands still: RViz has one light, at the eye, and leaves flat views dark.

A list of triangles with colours of their own is drawn as it is, so the light can be put into them.
"""

import math

from geometry_msgs.msg import Point, Vector3
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker

from ...sim.core import Quaternion, Vector, dot, rotate
from ...sim.description import Box, Cylinder, Geometry

SUN: Vector = (0.48, -0.10, 0.87)  # towards it; unit length, from where Gazebo's sun shines
# A face is this bright across the light; facing it and turned away it is that much more and less.
ACROSS, SWING = 0.62, 0.38
SEGMENTS = 32  # of a round side

Facet = tuple[Vector, tuple[Vector, Vector, Vector]]  # normal, and corners counter-clockwise [m]


def shade(marker: Marker, geometry: Geometry, orientation: Quaternion) -> None:
    """Let a marker of a plain colour be lit by the sun as it stands now, if its shape can be."""
    facets = _facets(geometry)
    if not facets:
        return
    marker.type, marker.scale = Marker.TRIANGLE_LIST, Vector3(1.0, 1.0, 1.0)
    marker.points, marker.colors = [], []
    own = marker.color
    for normal, corners in facets:
        light = brightness(rotate(orientation, normal))
        colour = ColorRGBA(own.r * light, own.g * light, own.b * light, own.a)
        marker.points += [Point(*corner) for corner in corners]
        marker.colors += [colour] * len(corners)


def brightness(normal: Vector) -> float:
    """Return by how much a face of that unit normal, in world axes, is lit: 0 to 1."""
    return ACROSS + SWING * dot(normal, SUN)


def _facets(geometry: Geometry) -> list[Facet]:
    match geometry:
        case Box((x, y, z)):
            return _box(x / 2.0, y / 2.0, z / 2.0)
        case Cylinder(radius, length):
            return _cylinder(radius, length / 2.0)
    return []


def _box(x: float, y: float, z: float) -> list[Facet]:
    facets = []
    for axis in range(3):
        second, third = (axis + 1) % 3, (axis + 2) % 3
        half = (x, y, z)
        for side in (-1.0, 1.0):
            normal, corners = [0.0, 0.0, 0.0], []
            normal[axis] = side
            for a, b in ((-side, -1.0), (side, -1.0), (side, 1.0), (-side, 1.0)):
                corner = [0.0, 0.0, 0.0]
                corner[axis], corner[second], corner[third] = (
                    side * half[axis], a * half[second], b * half[third])
                corners.append(tuple(corner))
            facets += _halves(tuple(normal), corners)
    return facets


def _cylinder(radius: float, half: float) -> list[Facet]:
    facets = []
    step = 2.0 * math.pi / SEGMENTS
    for number in range(SEGMENTS):
        (x, y), (u, v) = (
            (radius * math.cos(angle), radius * math.sin(angle))
            for angle in (number * step, (number + 1) * step))
        middle = (number + 0.5) * step
        facets += _halves((math.cos(middle), math.sin(middle), 0.0),
                          [(x, y, -half), (u, v, -half), (u, v, half), (x, y, half)])
        facets.append(((0.0, 0.0, 1.0), ((0.0, 0.0, half), (x, y, half), (u, v, half))))
        facets.append(((0.0, 0.0, -1.0), ((0.0, 0.0, -half), (u, v, -half), (x, y, -half))))
    return facets


def _halves(normal: Vector, corners: list[Vector]) -> list[Facet]:
    """Return the two triangles of a rectangle."""
    a, b, c, d = corners
    return [(normal, (a, b, c)), (normal, (a, c, d))]
