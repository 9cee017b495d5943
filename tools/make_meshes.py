#!/usr/bin/env python3
"""Make the robot's meshes: `tools/make_meshes.py [folder]` (default: the package's meshes folder).

Each mesh has its own coordinates, chosen so that the origins and scales in
urdf/rosbots.xacro put it in place; the dimensions below are in those coordinates. One unit of
rasp.dae is 25 mm of a real board.
"""

import math
import sys
from pathlib import Path

import numpy as np
from dae_writer import Colour, collada
from mesh_shapes import (
    Array,
    Surface,
    along_first_axis,
    at_height,
    block,
    circle,
    lathe,
    loft,
    moved,
    perforated,
    prism,
    rectangle,
    ring,
    turned,
)

Profile = list[tuple[float, float]]
Parts = list[tuple[Colour, Surface]]

STEEL = Colour('steel', (0.76, 0.79, 0.82), 0.5)
BLUE = Colour('blue', (0.16, 0.47, 0.86), 0.25)
RUBBER = Colour('rubber', (0.13, 0.13, 0.14), 0.05)
YELLOW = Colour('yellow', (0.98, 0.74, 0.05), 0.3)
GRAPHITE = Colour('graphite', (0.24, 0.25, 0.28), 0.3)
GREEN = Colour('green', (0.06, 0.58, 0.28), 0.2)
BLACK = Colour('black', (0.11, 0.11, 0.12), 0.2)
GOLD = Colour('gold', (0.88, 0.68, 0.25), 0.5)
WHITE = Colour('white', (0.93, 0.94, 0.95), 0.3)
RED = Colour('red', (0.78, 0.08, 0.07), 0.3)
GLASS = Colour('glass', (0.12, 0.22, 0.42), 0.9)


def base() -> Parts:
    """Return a deck, 1.1 x 1.0 x 0.05 m, corner at the origin: a perforated panel in a frame."""
    size, height, border, corner = (1.1, 1.0), 0.05, 0.035, 0.06
    bevel, panel_recess = 0.004, 0.003
    outer = rectangle((0.0, 0.0), size, corner, 4)
    outer_top = rectangle((bevel, bevel), (size[0] - bevel, size[1] - bevel), corner - bevel, 4)
    inner = rectangle((border, border), (size[0] - border, size[1] - border), corner - border, 4)
    frame = ring(
        [
            at_height(outer, bevel),
            at_height(outer, height - bevel),
            at_height(outer_top, height),
            at_height(inner, height),
            at_height(inner, 0.0),
            at_height(outer_top, 0.0),
        ]
    )

    # Holes in two lines along each long side; the four bosses carry the posts between the decks.
    hole_x = (0.24, 0.36, 0.48, 0.62, 0.74, 0.86)
    hole_y = (0.10, 0.20, 0.80, 0.90)
    sides = (-0.03, 0.03)  # of the cell that a hole is cut from
    columns = [0.03, *[x + side for x in hole_x for side in sides], size[0] - 0.03]
    rows = [0.03, *[y + side for y in hole_y for side in sides], size[1] - 0.03]
    holes = [(1 + 2 * i, 1 + 2 * j) for i in range(len(hole_x)) for j in range(len(hole_y))]
    panel = perforated(
        columns, rows, panel_recess, height - panel_recess, holes=holes, radius=0.016
    )
    boss = prism(circle(0.055, 16), 0.0, height, bevel)
    bosses = [(STEEL, moved(boss, (x, y, 0.0))) for x in (0.12, 1.02) for y in (0.1375, 0.8125)]
    return [(STEEL, frame), (BLUE, panel), *bosses]


def wheel() -> Parts:
    """Return a wheel about z, symmetric: radius 0.029 m, z 0.0017 to 0.0337 m."""
    radius, low, high, half = 0.0290, 0.0017, 0.0337, 0.0160
    # (radius [m], distance from the middle as a part of half the width), outside to inside
    tyre = [(0.0270, 0.72), (0.0262, 0.90), (0.0240, 1.0), (0.0212, 0.96), (0.0196, 0.85)]
    well = [(0.0198, 0.86), (0.0168, 0.86), (0.0168, 0.0)]
    lip = [(0.0200, 0.70), (0.0200, 0.93), (0.0176, 0.93), (0.0164, 0.86), (0.0164, 0.70)]

    def turned_profile(profile: Profile, sign: float) -> Profile:
        loop = [(r, sign * part * half) for r, part in profile]
        return loop[:: int(sign)]

    # A dark well with a yellow lip on each side, so that the yellow spokes stand out against it.
    parts = [
        (RUBBER, lathe(turned_profile(tyre, -1.0) + turned_profile(tyre, 1.0), 30)),
        (GRAPHITE, lathe(turned_profile(well, -1.0)[1:] + turned_profile(well, 1.0), 30)),
        *[(YELLOW, lathe(turned_profile(lip, sign), 30)) for sign in (-1.0, 1.0)],
    ]
    treads = 20  # divisible by four, so that the bounding box is as wide as the circle
    for i in range(treads):
        turn = i * 2.0 * math.pi / treads
        parts += [
            (RUBBER, turned(_tread(radius, half, math.pi / treads, sign), turn))
            for sign in (-1.0, 1.0)
        ]
    spoke = block((0.004, -0.0026, -0.62 * half), (0.0170, 0.0026, 0.62 * half), 0.0008)
    bolt = prism(circle(0.0009, 6, (0.0062, 0.0)), -0.80 * half, 0.80 * half)
    for i in range(5):
        parts += [
            (YELLOW, turned(spoke, i * 0.4 * math.pi)),
            (STEEL, turned(bolt, (i + 0.5) * 0.4 * math.pi)),
        ]
    parts += [
        (GRAPHITE, prism(circle(0.0080, 20), -0.72 * half, 0.72 * half, 0.0012)),
        (STEEL, prism(circle(0.0040, 14), -0.88 * half, 0.88 * half, 0.0010)),
    ]
    middle = (0.0, 0.0, (low + high) / 2.0)
    return [(colour, moved(surface, middle)) for colour, surface in parts]


def _tread(radius: float, half: float, width: float, sign: float) -> Array:
    """Return one tread block of a tractor tyre, slanting back from the middle to the side `sign`.

    `width` is the angle it covers; its front inner corner lies on the first axis at `radius`.
    """
    root, shoulder, slant = 0.0262, 0.0279, 0.7 * width

    def section(crown: float, start: float, height: float) -> Array:
        corners = ((root, start), (crown, start), (crown, start + width), (root, start + width))
        return np.array([(r * math.cos(turn), r * math.sin(turn), height) for r, turn in corners])

    ends = [section(radius, 0.0, sign * 0.04 * half), section(shoulder, slant, sign * 0.86 * half)]
    return loft(ends[:: int(sign)])


def rasp() -> Parts:
    """Return a single-board computer: x 6.8 to 10.2, y 4.4 to 6.7, z from 0.

    Its parts are listed in millimetres from the board's corner; `top` is its upper side.
    """
    origin, per_mm, top = (6.8, 4.4, 0.0), 0.04, 1.6
    parts = [(GREEN, prism(rectangle((0.0, 0.0), (83.0, 57.5), 4.0, 3), 0.0, top))]
    pad = lathe([(2.2, top - 0.2), (3.4, top - 0.2), (3.4, top + 0.25), (2.2, top + 0.25)], 16)
    parts += [
        (GOLD, moved(pad, (x, y, 0.0)))  # where the posts of the URDF pass
        for x in (11.7, 76.4)
        for y in (9.75, 40.75)
    ]

    parts.append((BLACK, block((9.0, 50.0, top), (60.0, 55.2, top + 2.5))))
    parts += [
        (GOLD, block((x, y, top + 2.5), (x + 1.1, y + 1.1, top + 8.5)))
        for x in np.arange(10.2, 59.0, 3.2)
        for y in (50.9, 53.2)
    ]
    # colour, two opposite corners, height above the board, bevel
    for colour, low, high, height, bevel in (
        (BLACK, (26.0, 20.0), (41.0, 35.0), 1.6, 0.0),  # processor,
        (STEEL, (28.5, 22.5), (38.5, 32.5), 2.4, 0.3),  # with its lid
        (BLACK, (46.0, 21.0), (57.0, 33.0), 1.4, 0.0),  # memory
        (BLACK, (61.0, 25.0), (68.0, 32.0), 1.2, 0.0),  # USB controller
        (BLACK, (17.0, 38.0), (24.0, 44.0), 1.2, 0.0),  # power regulator
        (STEEL, (4.0, 21.0), (8.0, 35.0), 1.8, 0.0),  # card
        (STEEL, (16.0, 0.0), (24.0, 6.0), 3.0, 0.4),  # sockets: power,
        (STEEL, (30.0, 0.0), (45.0, 11.0), 6.0, 0.6),  # video,
        (BLACK, (52.0, 0.0), (59.0, 13.0), 6.0, 0.4),  # sound,
        (STEEL, (64.0, 44.2), (84.7, 57.0), 13.4, 0.5),  # network,
        (STEEL, (68.5, 13.2), (84.7, 24.8), 14.8, 0.5),  # USB,
        (STEEL, (68.5, 25.6), (84.7, 37.2), 14.8, 0.5),  # USB
        (RED, (2.5, 9.0), (4.5, 10.2), 0.9, 0.0),  # lamps
        (YELLOW, (2.5, 12.0), (4.5, 13.2), 0.9, 0.0),
    ):
        parts.append((colour, block((*low, top), (*high, top + height), bevel)))
    mouths = [(46.2, 3.2, 8.8, 8.3), *[(y, z, 9.0, 4.8) for y in (14.5, 26.9) for z in (3.2, 10.0)]]
    parts += [
        (BLACK, block((84.0, y, z), (85.0, y + width, z + height)))
        for y, z, width, height in mouths
    ]
    parts += [
        (GOLD, block((x, y, top), (x + 1.6, y + 0.9, top + 0.7)))
        for x in (28.0, 31.5, 35.0, 47.0, 50.5, 54.0)
        for y in (15.0, 17.2, 38.0, 40.2)
    ]
    return [(colour, moved(surface * per_mm, origin)) for colour, surface in parts]


def battery() -> Parts:
    """Return a battery pack, long in x and up in y, to be scaled by 13, 6, 6 in the URDF."""
    low, high = (-0.2846, 0.0019, -0.0340), (-0.2136, 0.0259, 0.0)
    cap_length, terminal = 0.0050, 0.0012

    def section(grow: float) -> Array:
        return rectangle(
            (low[1] - grow, low[2] - grow), (high[1] + grow, high[2] + grow), 0.0060 + grow, 4
        )

    def piece(start: float, end: float, grow: float, bevel: float = 0.0) -> Surface:
        return along_first_axis(prism(section(grow), low[0] + start, low[0] + end, bevel))

    length = high[0] - low[0]
    parts = [
        (WHITE, piece(cap_length, length - cap_length, -0.0008)),
        (BLUE, piece(0.0200, 0.0510, -0.0004)),
        (GRAPHITE, piece(terminal, terminal + cap_length, 0.0, 0.0004)),
        (GRAPHITE, piece(length - terminal - cap_length, length - terminal, 0.0, 0.0004)),
    ]
    middle_y = (low[1] + high[1]) / 2.0
    for z, colour in ((low[2] + 0.0100, RED), (high[2] - 0.0100, STEEL)):
        pole = along_first_axis(prism(circle(0.0032, 12, (middle_y, z)), low[0], high[0]))
        parts.append((colour, pole))
    parts += [
        (
            YELLOW,
            block(
                (low[0] + x, high[1] - 0.0010, -0.0185),
                (low[0] + x + 0.0012, high[1] - 0.0002, -0.0155),
            ),
        )
        for x in (0.0545, 0.0570, 0.0595, 0.0620)
    ]
    return parts


def camera() -> Parts:
    """Return a camera that looks along x: 0.0197 deep, 0.0709 wide along y, 0.0472 high along z."""
    depth, width, height, body = 0.0197, 0.0709, 0.0472, 0.0135
    outline = rectangle((0.0, 0.0), (width, height), 0.009, 4)
    centre = (width / 2.0, height / 2.0)

    seat = body - 0.001  # parts on the front begin inside it

    def barrel(profile: Profile) -> Surface:
        return moved(along_first_axis(lathe(profile, 24)), (0.0, *centre))

    def stud(radius: float, points: int, y: float, z: float) -> Surface:
        return along_first_axis(prism(circle(radius, points, (y, z)), seat, body + 0.0006))

    glass = [
        (0.0108, seat),
        (0.0108, depth - 0.0028),
        (0.0080, depth - 0.0018),
        (0.0040, depth - 0.0014),
    ]
    return [
        (GRAPHITE, along_first_axis(prism(outline, 0.0, body, 0.0015))),
        (
            STEEL,
            barrel(
                [
                    (0.0145, seat),
                    (0.0175, seat),
                    (0.0175, body + 0.0012),
                    (0.0165, body + 0.0022),
                    (0.0145, body + 0.0022),
                ]
            ),
        ),
        (
            BLACK,
            barrel(
                [
                    (0.0105, seat),
                    (0.0150, seat),
                    (0.0142, depth - 0.0008),
                    (0.0134, depth),
                    (0.0118, depth),
                    (0.0105, depth - 0.0016),
                ]
            ),
        ),
        (
            GLASS,
            along_first_axis(
                loft([at_height(circle(radius, 20, centre), x) for radius, x in glass])
            ),
        ),
        *[
            (STEEL, stud(0.0020, 8, y, z))
            for y in (0.007, width - 0.007)
            for z in (0.007, height - 0.007)
        ],
        (RED, stud(0.0016, 10, width - 0.0085, height / 2.0)),
    ]


# The article's camera mesh declares y up; no tool of ROS rotates a mesh for that.
MESHES = {
    'base': (base, 'Z_UP'),
    'battery': (battery, 'Z_UP'),
    'camera': (camera, 'Y_UP'),
    'rasp': (rasp, 'Z_UP'),
    'wheel': (wheel, 'Z_UP'),
}


def main(arguments: list[str]) -> int:
    """Write every mesh to the folder named by the first argument; return the exit code."""
    folder = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent / 'meshes'
    folder.mkdir(parents=True, exist_ok=True)
    for name, (make, up_axis) in MESHES.items():
        (folder / f'{name}.dae').write_text(collada(name, make(), up_axis), encoding='utf-8')
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
