#!/usr/bin/env python3
"""Make the built-in models: `tools/make_models.py [folder]` (default: the package's models folder).

They have the names, sizes, masses and frames of the models of Gazebo's database that public worlds
include most, and plain shapes of our own. Their mesh files have the names, units and frames of the
database's, as worlds that Gazebo saved name these. Lengths in metres, angles in radians, z up, in
the model's link.
"""

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from dae_writer import Colour, collada
from mesh_shapes import (
    Array,
    Surface,
    along_first_axis,
    at_height,
    block,
    cap,
    circle,
    loft,
    moved,
    prism,
    rectangle,
    turned,
)

Point = tuple[float, float, float]
Rgb = tuple[float, float, float]

WOOD, DARK_WOOD = (0.67, 0.55, 0.32), (0.45, 0.33, 0.2)
GREY, DARK, STEEL, BLACK = (0.62,) * 3, (0.25,) * 3, (0.5, 0.52, 0.54), (0.06,) * 3
WHITE, CONCRETE, CARDBOARD = (0.92,) * 3, (0.61, 0.61, 0.59), (0.67, 0.54, 0.31)
ORANGE, RED, YELLOW = (0.9, 0.32, 0.04), (0.62, 0.02, 0.02), (0.95, 0.85, 0.15)
GREEN, BLUE = (0.13, 0.25, 0.17), (0.2, 0.3, 0.6)
SKIN, JEANS, SHIRT = (0.78, 0.58, 0.46), (0.2, 0.26, 0.4), (0.55, 0.2, 0.2)
SIDES = 16  # of a circle


@dataclass(frozen=True)
class Part:
    """A shape: its element in <geometry>, where it is, its colour; None: it is not visible.

    `surface` is the shape in triangles, about the origin.
    """

    geometry: str
    surface: Surface
    at: Point
    turn: Point = (0.0, 0.0, 0.0)
    colour: Rgb | None = GREY
    solid: bool = True


@dataclass(frozen=True)
class Model:
    """A model of one link. `mass` 0: static; None: that of SDF, 1 kg and 1 kg m^2.

    Attributes:
        heights: of the model above where it is included, and of its link above the model.
        mesh: coloured surfaces that are visible besides the parts, in the model's mesh file.
        size: extents of the box, with its centre, whose inertia it has.
    """

    parts: Sequence[Part]
    mass: float | None = 0.0
    name: str = ''
    heights: tuple[float, float] = (0.0, 0.0)
    mesh: Sequence[tuple[Rgb, Surface]] = ()
    size: Point = (0.0, 0.0, 0.0)
    centre: float = 0.0
    link: str = 'link'


@dataclass(frozen=True)
class MeshFile:
    """The mesh file that a model of the database is shown by, and how its <visual> places it."""

    name: str
    scale: Point = (1.0, 1.0, 1.0)
    at: Point = (0.0, 0.0, 0.0)
    turn: Point = (0.0, 0.0, 0.0)


def _text(numbers: Sequence[float]) -> str:
    return ' '.join(f'{round(number, 6) + 0.0:.6g}' for number in numbers)


def box(
    size: Point,
    at: Point,
    colour: Rgb | None = GREY,
    turn: Point = (0.0, 0.0, 0.0),
    solid: bool = True,
) -> Part:
    """Return a box, `at` its centre."""
    surface = block([-side / 2.0 for side in size], [side / 2.0 for side in size])
    return Part(f'<box><size>{_text(size)}</size></box>', surface, at, turn, colour, solid)


def cylinder(
    radius: float,
    length: float,
    at: Point,
    colour: Rgb | None = GREY,
    turn: Point = (0.0, 0.0, 0.0),
    solid: bool = True,
) -> Part:
    """Return a cylinder about z before it is turned, `at` its centre."""
    return Part(
        f'<cylinder><radius>{_text([radius])}</radius><length>{_text([length])}</length>'
        '</cylinder>',
        prism(circle(radius, SIDES), -length / 2.0, length / 2.0),
        at,
        turn,
        colour,
        solid,
    )


def ball(radius: float, at: Point, colour: Rgb, solid: bool = True) -> Part:
    """Return a sphere."""
    loops = [
        at_height(circle(radius * math.cos(angle), SIDES), radius * math.sin(angle))
        for angle in np.radians([-80.0, -50.0, -17.0, 17.0, 50.0, 80.0])
    ]
    return Part(
        f'<sphere><radius>{_text([radius])}</radius></sphere>',
        loft(loops),
        at,
        (0.0, 0.0, 0.0),
        colour,
        solid,
    )


def cone(
    bands: Sequence[tuple[float, float, Rgb]], top: tuple[float, float]
) -> list[tuple[Rgb, Surface]]:
    """Return frustums, one on the other: (radius, height) of each lower rim with its colour."""
    rims = [*((radius, height) for radius, height, _ in bands), top]
    return [
        (
            colour,
            loft(
                [
                    at_height(circle(*low[:1], SIDES), low[1]),
                    at_height(circle(*high[:1], SIDES), high[1]),
                ]
            ),
        )
        for (_, _, colour), low, high in zip(bands, rims, rims[1:], strict=False)
    ]


def rotation(turn: Point) -> Array:
    """Return the matrix of roll, pitch and yaw."""
    (a, b, c), (d, e, f) = np.cos(turn), np.sin(turn)
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, a, -d], [0.0, d, a]])
    about_y = np.array([[b, 0.0, e], [0.0, 1.0, 0.0], [-e, 0.0, b]])
    about_z = np.array([[c, -f, 0.0], [f, c, 0.0], [0.0, 0.0, 1.0]])
    matrix: Array = about_z @ about_y @ about_x
    return matrix


def barrier(length: float, profile: Sequence[tuple[float, float]]) -> Surface:
    """Return the profile (half width, height) of a barrier, extruded along x about the origin."""
    right = [(-y, z) for y, z in profile]
    outline = np.array([*right, *((y, z) for y, z in reversed(profile))])[::-1]
    return along_first_axis(prism(outline, -length / 2.0, length / 2.0))


# Half width and height of a barrier as the documented one of 1.143 m: foot, slope, wall.
_PROFILE = [(0.405, 0.0), (0.405, 0.065), (0.2, 0.385), (0.1, 1.143)]


def _jersey_barrier() -> Model:
    slope = math.atan2(0.32, 0.205)
    return Model(
        [
            box((4.065, 0.306, 1.143), (0.0, 0.0, 0.5715), None),
            box((4.065, 0.81, 0.065), (0.0, 0.0, 0.0325), None),
            *(
                box((4.065, 0.38, 0.1), (0.0, side * 0.263, 0.194), None, (-side * slope, 0.0, 0.0))
                for side in (-1.0, 1.0)
            ),
        ],
        mesh=[(CONCRETE, barrier(4.065, _PROFILE))],
    )


def _practice_barrier(colour: Rgb, name: str = '') -> Model:
    surface = moved(
        turned(
            barrier(1.801, [(y * 0.304 / 0.405, z * 1.05 / 1.143) for y, z in _PROFILE]),
            math.pi / 2.0,
        ),
        (0, -0.0305, 0),
    )
    return Model(
        [
            box((0.608, 1.801, 0.06), (0.0, -0.0305, 0.03), None),
            box((0.42, 1.801, 0.3), (0.0, -0.0305, 0.21), None),
            box((0.23, 1.801, 1.05), (0.0, -0.0305, 0.525), None),
        ],
        name=name,
        mesh=[(colour, surface)],
    )


def _person(walking: bool) -> Model:
    """Return a person in the box whose inertia the documented one has, facing -y.

    It measures 0.5 x 0.35 x 1.9 m standing, 0.1 m ahead of the origin, and 0.35 x 0.75 x 1.9 m
    walking.
    """
    swing, arm, leg, ahead = (0.216, 0.125, 0.08, 0.0) if walking else (0.0, 0.2, 0.1, 0.1)
    limbs = []
    for side in (-1.0, 1.0):  # as if it faced x
        lean = (0.0, side * swing, 0.0)
        foot = -side * 0.91 * math.sin(swing) / 2.0
        limbs += [
            cylinder(0.075, 0.91, (foot, side * leg, 0.475), JEANS, lean),
            box((0.26, 0.1, 0.08), (2.0 * foot + 0.05, side * leg, 0.04), DARK),
            cylinder(
                0.045, 0.63, (-foot / 2.0, side * arm, 1.22), SHIRT, (0.0, -side * swing * 0.7, 0.0)
            ),
            ball(0.05, (-foot, side * arm, 0.89), SKIN),
        ]
    body = [
        box((0.2, 1.6 * arm, 0.64), (0.0, 0.0, 1.22), SHIRT),
        cylinder(0.055, 0.1, (0, 0, 1.58), SKIN),
        ball(0.125, (0.0, 0.0, 1.775), SKIN),
        ball(0.125, (-0.01, 0.0, 1.785), DARK_WOOD, False),
    ]
    parts = [
        replace(
            part,
            at=(part.at[1], -part.at[0] - ahead, part.at[2]),
            turn=(0.0, 0.0, -math.pi / 2.0) if not any(part.turn) else (part.turn[1], 0.0, 0.0),
        )
        for part in [*limbs, *body]
    ]
    size = (0.35, 0.75, 1.9) if walking else (0.5, 0.35, 1.9)
    base = box((*size[:2], 0.02), (0.0, -ahead, 0.01), None)
    return Model([base, *parts], mass=80.0, size=size, centre=0.95)


def _shelves(planks: Sequence[tuple[Point, Point]], link: str = 'link') -> Model:
    return Model([box(size, at, DARK_WOOD) for size, at in planks], link=link)


def _gas_station() -> Model:
    """Return a canopy over four pumps, with a shop behind it."""
    posts = [(x, y) for x in (-7.0, 7.0) for y in (-20.0, -14.0)]
    pumps = [
        part
        for x in (-3.5, 3.5)
        for y in (-20.0, -14.0)
        for part in (
            box((2.4, 1.2, 0.2), (x, y, 0.1), CONCRETE),
            box((0.9, 0.6, 1.6), (x, y, 1.0), WHITE),
            box((0.7, 0.62, 0.5), (x, y, 1.35), DARK),
        )
    ]
    return Model(
        [
            box((20.57, 14.0, 0.9), (0.0, -17.17, 6.0), WHITE),
            box((20.55, 13.9, 0.3), (0.0, -17.17, 6.1), RED, solid=False),
            *(cylinder(0.3, 5.55, (x, y, 2.775), STEEL) for x, y in posts),
            *pumps,
            box((14.0, 10.0, 4.2), (0.0, 0.809, 2.1), (0.69, 0.6, 0.57)),
            box((14.4, 10.0, 0.3), (0.0, 0.809, 4.35), DARK),
            box((5.0, 0.1, 2.4), (-3.5, -4.2, 1.5), (0.3, 0.4, 0.5), solid=False),
            box((1.6, 0.1, 2.2), (3.5, -4.2, 1.1), DARK, solid=False),
            cylinder(0.2, 8.0, (9.5, -9.0, 4.0), STEEL),
            box((1.5, 0.3, 1.6), (9.5, -9.0, 8.18), RED),
        ],
        name='Gas Station',
    )


def _checkers() -> list[tuple[Rgb, Surface]]:
    """Return eight by eight squares of 0.25 m at z = 0, seen from above."""
    square = cap(at_height(rectangle((0.0, 0.0), (0.25, 0.25)), 0.0))
    return [
        (WHITE if (i + j) % 2 else BLACK, moved(square, (i / 4 - 1.0, j / 4 - 1.0, 0.0)))
        for i in range(8)
        for j in range(8)
    ]


def _stop_sign() -> Model:
    face = turned(along_first_axis(prism(circle(0.3215, 8), 0.001, 0.009)), math.pi / 2.0)
    face = face @ rotation((0.0, math.pi / 8.0, 0.0)).T
    return Model(
        [
            box((0.594, 0.012, 0.594), (0.0, -0.005, 1.521), None),
            box((0.06, 0.02, 1.5), (0.0, 0.001, 0.75), STEEL),
        ],
        name='Stop Sign',
        mesh=[(RED, moved(_flat(face), (0.0, 0.0, 1.521)))],
    )


def _flat(surface: Surface) -> Surface:
    """Return a surface whose front is at y = -0.012."""
    return moved(surface, (0.0, -0.012 - surface[:, :, 1].min(), 0.0))


def _barrel() -> list[tuple[Rgb, Surface]]:
    return cone(
        [
            (0.51, 0.0, BLACK),
            (0.42, 0.12, ORANGE),
            (0.41, 0.4, WHITE),
            (0.4, 0.62, ORANGE),
            (0.39, 0.84, WHITE),
            (0.38, 1.06, ORANGE),
            (0.37, 1.3, WHITE),
            (0.365, 1.45, ORANGE),
        ],
        (0.3, 1.55),
    )


MODELS = {
    'asphalt_plane': Model([box((20.0, 20.0, 0.1), (0.0, 0.0, 0.0), (0.5, 0.5, 0.51))]),
    'beer': Model(
        [
            cylinder(0.055, 0.23, (0.0, 0.0, 0.0), (0.55, 0.35, 0.1)),
            cylinder(0.0552, 0.1, (0.0, 0.0, 0.02), (0.85, 0.75, 0.5), solid=False),
        ],
        mass=0.39,
        heights=(0.0, 0.115),
        size=(0.095, 0.095, 0.23),
    ),
    'bookshelf': _shelves(
        [
            ((0.9, 0.01, 1.2), (0.0, 0.005, 0.6)),
            ((0.02, 0.4, 1.2), (0.45, -0.195, 0.6)),
            ((0.02, 0.4, 1.2), (-0.45, -0.195, 0.6)),
            ((0.88, 0.4, 0.06), (0.0, -0.195, 0.03)),
            *(((0.88, 0.4, 0.02), (0.0, -0.195, z)) for z in (0.43, 0.8, 1.19)),
        ]
    ),
    'brick_box_3x1x3': Model(
        [box((3.0, 1.0, 3.0), (0.0, 0.0, 0.0), (0.56, 0.38, 0.37))],
        heights=(0.0, 1.5),
        link='chassis',
    ),
    'cabinet': _shelves(
        [
            *(((0.45, 0.45, 0.02), (0.0, 0.0, z)) for z in (0.01, 0.51, 1.01)),
            ((0.02, 0.45, 1.02), (0.235, 0.0, 0.51)),
            *(((0.45, 0.02, 1.02), (0.0, y, 0.51)) for y in (-0.235, 0.235)),
        ],
        link='cabinet_bottom_plate',
    ),
    'cafe_table': Model(
        [
            box((0.913, 0.913, 0.04), (0.0, 0.0, 0.755), WOOD),
            box((0.042, 0.042, 0.74), (0.0, 0.0, 0.37), DARK),
            box((0.56, 0.56, 0.04), (0.0, 0.0, 0.02), DARK),
        ]
    ),
    'cardboard_box': Model(
        [
            box((0.5, 0.4, 0.3), (0.0, 0.0, 0.0), CARDBOARD),
            box((0.5002, 0.05, 0.3002), (0.0, 0.0, 0.0), (0.8, 0.7, 0.5), solid=False),
        ],
        mass=2.0,
        heights=(0.15, 0.0),
        size=(0.5, 0.4, 0.3),
    ),
    'checkerboard_plane': Model([], mesh=_checkers()),
    'cinder_block': Model(
        [box((0.43495, 0.0339, 0.2032), (0.0, y, 0.1016)) for y in (-0.08465, 0.08465)]
        + [box((0.0339, 0.1354, 0.203), (x, 0.0, 0.1016)) for x in (-0.18625, 0.0, 0.18625)],
        mass=5.0,
        size=(0.37, 0.17, 0.2),
        centre=0.1016,
    ),
    'coke_can': Model(
        [
            cylinder(0.0335, 0.115, (0.0, 0.0, 0.0645), (0.7, 0.05, 0.05)),
            cylinder(0.029, 0.123, (0.0, 0.0, 0.0645), (0.75, 0.75, 0.75)),
        ],
        mass=0.39,
        size=(0.067, 0.067, 0.12),
        centre=0.06,
    ),
    'construction_barrel': Model(
        [
            cylinder(0.51, 0.12, (0.0, 0.0, 0.06), None),
            cylinder(0.42, 1.55, (0.0, 0.0, 0.775), None),
        ],
        mass=500.0,
        name='Construction Barrel',
        mesh=_barrel(),
        size=(0.78, 0.78, 0.8),
        centre=0.4,
    ),
    'construction_cone': Model(
        [
            box((0.5, 0.5, 0.06), (0.0, 0.0, 0.03), BLACK),
            cylinder(0.19, 0.3, (0.0, 0.0, 0.21), None),
            cylinder(0.12, 0.4, (0.0, 0.0, 0.56), None),
            cylinder(0.07, 0.33, (0.0, 0.0, 0.924), None),
        ],
        mass=None,
        name='Construction Cone',
        mesh=cone(
            [
                (0.2, 0.06, ORANGE),
                (0.145, 0.42, WHITE),
                (0.115, 0.6, ORANGE),
                (0.1, 0.72, WHITE),
                (0.08, 0.84, ORANGE),
            ],
            (0.035, 1.089),
        ),
    ),
    'drc_practice_blue_cylinder': Model(
        [cylinder(0.279, 0.863, (0.0, 0.0, 0.4315), (0.19, 0.19, 1.0))]
    ),
    'drc_practice_orange_jersey_barrier': _practice_barrier(
        (0.8, 0.395, 0.0), 'drc_practice_organge_jersey_barrier'
    ),
    'drc_practice_white_jersey_barrier': _practice_barrier(WHITE),
    'drc_practice_yellow_parking_block': Model(
        [
            box((0.16, 1.804, 0.06), (0.0, 0.0, 0.03), YELLOW),
            box((0.11, 1.78, 0.102), (0.0, 0.0, 0.051), YELLOW),
        ]
    ),
    'dumpster': Model(
        [
            box((2.2, 1.4, 1.3), (0.0, 0.0, 0.8), GREEN),
            *(box((2.5, 0.1, 0.12), (0.0, y, 1.4), GREEN) for y in (-0.718, 0.718)),
            box((2.2, 1.45, 0.12), (0.0, 0.02, 1.57), DARK, (0.2, 0.0, 0.0)),
            *(box((0.15, 1.1, 0.25), (x, 0.0, 1.1), DARK) for x in (-1.178, 1.178)),
            *(
                cylinder(0.075, 0.08, (x, y, 0.075), BLACK, (math.pi / 2.0, 0.0, 0.0))
                for x in (-0.95, 0.95)
                for y in (-0.55, 0.55)
            ),
        ],
        mass=None,
        name='Dumpster',
    ),
    'fire_hydrant': Model(
        [
            cylinder(0.21, 0.08, (0.0, 0.0, 0.04), RED),
            cylinder(0.11, 0.7, (0.0, 0.0, 0.39), RED),
            cylinder(0.15, 0.05, (0.0, 0.0, 0.68), RED),
            ball(0.13, (0.0, 0.0, 0.74), RED),
            cylinder(0.03, 0.1, (0.0, 0.0, 0.879), DARK),
            cylinder(0.06, 0.424, (0.0, 0.0, 0.52), RED, (math.pi / 2.0, 0.0, 0.0)),
            cylinder(0.08, 0.212, (0.106, 0.0, 0.48), RED, (0.0, math.pi / 2.0, 0.0)),
            cylinder(0.04, 0.423, (0.0, 0.0, 0.52), DARK, (math.pi / 2.0, 0.0, 0.0), solid=False),
        ]
    ),
    'first_2015_trash_can': Model(
        [
            cylinder(0.24, 0.7, (0.0, 0.0, 0.35), (0.35, 0.38, 0.42)),
            cylinder(0.28, 0.06, (0.0, 0.0, 0.707), (0.3, 0.42, 0.54)),
            *(box((0.1, 0.06, 0.1), (0.0, y, 0.6), DARK) for y in (-0.289, 0.289)),
        ],
        mass=4.83076,
        size=(0.4, 0.4, 0.737),
        centre=0.3683,
    ),
    'gas_station': _gas_station(),
    'grey_wall': Model(
        [box((7.5, 0.2, 2.8), (0.0, 0.0, 0.0), (0.78, 0.77, 0.77))], heights=(0.0, 1.4)
    ),
    'jersey_barrier': _jersey_barrier(),
    'lamp_post': Model(
        [
            box((0.488, 0.212, 0.5), (0.0, 0.0, 0.25), GREY),
            cylinder(0.1, 9.2, (0.0, 0.0, 4.6), GREY),
            box((0.1, 2.7, 0.1), (0.0, -1.3, 9.222), GREY),
            box((0.36, 0.8, 0.12), (0.0, -2.676, 9.15), (0.95, 0.93, 0.8)),
        ],
        name='Lamp Post',
    ),
    'mailbox': Model(
        [
            box((0.1, 0.1, 0.87), (0.0, 0.0, 0.435), DARK_WOOD),
            box((0.13, 0.35, 0.13), (0.002, 0.017, 0.937), (0.25, 0.25, 0.24)),
            cylinder(
                0.065, 0.35, (0.002, 0.017, 1.002), (0.25, 0.25, 0.24), (math.pi / 2.0, 0.0, 0.0)
            ),
            box((0.006, 0.03, 0.12), (0.066, -0.02, 1.0), RED, solid=False),
        ],
        mass=None,
        name='Mailbox',
    ),
    'person_standing': _person(walking=False),
    'person_walking': _person(walking=True),
    'postbox': Model(
        [
            box((0.68, 0.66, 1.0), (0.0, 0.0, 0.68), BLUE),
            cylinder(0.33, 0.68, (0.0, 0.0, 1.19), BLUE, (0.0, math.pi / 2.0, 0.0)),
            box((0.4, 0.03, 0.06), (0.0, -0.326, 1.1), DARK, solid=False),
            *(
                box((0.08, 0.08, 0.18), (x, y, 0.09), DARK)
                for x in (-0.28, 0.28)
                for y in (-0.27, 0.27)
            ),
        ]
    ),
    'stop_sign': _stop_sign(),
    'table': Model(
        [
            box((1.5, 0.8, 0.03), (0.0, 0.0, 1.0), DARK_WOOD),
            *(cylinder(0.02, 1.0, (x, y, 0.5)) for x in (-0.68, 0.68) for y in (-0.38, 0.38)),
        ]
    ),
    'table_marble': Model(
        [
            box((2.612, 1.903, 0.06), (0.0, -0.1225, 0.0), (0.8, 0.81, 0.84)),
            *(
                box((0.12, 0.12, 0.616), (x, y, -0.338), DARK)
                for x in (-1.15, 1.15)
                for y in (-0.95, 0.7)
            ),
        ],
        heights=(0.648, 0.0),
    ),
}

# Without an entry, Gazebo's model consists of plain shapes.
MESH_FILES = {
    'brick_box_3x1x3': MeshFile('simple_box', (3.0, 1.0, 3.0)),
    'cafe_table': MeshFile('cafe_table'),
    'cardboard_box': MeshFile(
        'cardboard_box', (1.25931896, 1.007455168, 0.755591376), (0.0, 0.0, -0.15)
    ),
    'checkerboard_plane': MeshFile('checkerboard_plane'),
    'cinder_block': MeshFile('cinder_block'),
    'coke_can': MeshFile('coke_can', at=(0.003937, 0.0047244, -0.18)),
    'construction_barrel': MeshFile('construction_barrel'),
    'construction_cone': MeshFile('construction_cone', (10.0, 10.0, 10.0)),
    'drc_practice_blue_cylinder': MeshFile('cylinder'),
    'drc_practice_orange_jersey_barrier': MeshFile('jersey_barrier'),
    'drc_practice_white_jersey_barrier': MeshFile('jersey_barrier'),
    'drc_practice_yellow_parking_block': MeshFile('block'),
    'dumpster': MeshFile('dumpster', (1.5, 1.5, 1.5)),
    'fire_hydrant': MeshFile('fire_hydrant'),
    'first_2015_trash_can': MeshFile('trash_can'),
    'gas_station': MeshFile('gas_station'),
    'jersey_barrier': MeshFile('jersey_barrier'),
    'lamp_post': MeshFile('lamp_post', (3.0, 3.0, 3.0)),
    'mailbox': MeshFile('mailbox'),
    'person_standing': MeshFile('standing', at=(0.0, 0.0, 0.02), turn=(0.04, 0.0, 0.0)),
    'person_walking': MeshFile('walking', at=(0.0, 0.0, -0.02)),
    'postbox': MeshFile('postbox'),
    'stop_sign': MeshFile('stop_sign'),
    'table_marble': MeshFile('table_lightmap', (0.25, 0.25, 0.25)),
}


def sdf(name: str, model: Model) -> str:
    """Return the text of the model's SDF."""
    model_pose, link_pose = (
        f'    <pose>0 0 {_text([height])} 0 0 0</pose>\n' if height else ''
        for height in model.heights
    )
    static = '    <static>true</static>\n' if model.mass == 0.0 else ''
    mesh = MESH_FILES.get(name)
    shapes = [
        line
        for number, part in enumerate(model.parts)
        for line in _shapes(number, part if mesh is None else replace(part, colour=None))
    ]
    if mesh is not None:
        shapes.append(
            f'      <visual name="visual"><pose>{_text([*mesh.at, *mesh.turn])}</pose><geometry>'
            f'<mesh><uri>model://{name}/meshes/{mesh.name}.dae</uri>'
            f'<scale>{" ".join(map(repr, mesh.scale))}</scale></mesh></geometry></visual>\n'
        )
    return (
        f'<?xml version="1.0"?>\n<!-- Made by tools/make_models.py. -->\n<sdf version="1.6">\n'
        f'  <model name="{model.name or name}">\n{model_pose}{static}'
        f'    <link name="{model.link}">\n{link_pose}{_inertial(model)}{"".join(shapes)}'
        '    </link>\n  </model>\n</sdf>\n'
    )


def _shapes(number: int, part: Part) -> list[str]:
    pose = f'<pose>{_text([*part.at, *part.turn])}</pose><geometry>{part.geometry}</geometry>'
    lines = [f'      <collision name="part_{number}">{pose}</collision>\n'] if part.solid else []
    if part.colour is not None:
        colour = _text([*part.colour, 1.0])
        lines.append(
            f'      <visual name="part_{number}">{pose}<material><ambient>{colour}'
            f'</ambient><diffuse>{colour}</diffuse></material></visual>\n'
        )
    return lines


def _inertial(model: Model) -> str:
    """Return the mass of a moving model and the inertia of a solid box of its size."""
    if not model.mass:
        return ''
    x, y, z = (extent * extent * model.mass / 12.0 for extent in model.size)
    moments = ''.join(
        f'<{key}>{_text([value])}</{key}>'
        for key, value in (('ixx', y + z), ('iyy', x + z), ('izz', x + y))
    )
    return (
        f'      <inertial><pose>0 0 {_text([model.centre])} 0 0 0</pose>'
        f'<mass>{_text([model.mass])}</mass><inertia>{moments}</inertia></inertial>\n'
    )


def _mesh(model: Model, mesh: MeshFile) -> list[tuple[Colour, Surface]]:
    """Return all that is visible of a model, in the unit and frame of its mesh file."""
    shown = [
        (part.colour, part.surface @ rotation(part.turn).T + part.at)
        for part in model.parts
        if part.colour is not None
    ]
    return [
        (
            Colour(f'c{"_".join(_text([c]).replace(".", "") for c in rgb)}', rgb),
            (surface - mesh.at) @ rotation(mesh.turn) / mesh.scale,
        )
        for rgb, surface in (*shown, *model.mesh)
    ]


def main(arguments: list[str]) -> int:
    """Write every model to the folder named by the first argument; return the exit code."""
    folder = (
        Path(arguments[0])
        if arguments
        else Path(__file__).resolve().parents[1] / 'src' / 'rosbots_description' / 'models'
    )
    for name, model in MODELS.items():
        place = folder / name
        place.mkdir(parents=True, exist_ok=True)
        (place / 'model.sdf').write_text(sdf(name, model), encoding='utf-8')
        if name in MESH_FILES:
            mesh = MESH_FILES[name]
            (place / 'meshes').mkdir(exist_ok=True)
            (place / 'meshes' / f'{mesh.name}.dae').write_text(
                collada(mesh.name, _mesh(model, mesh), tool='tools/make_models.py'),
                encoding='utf-8',
            )
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
