#!/usr/bin/env python3
"""Make the meshes of gazebo_plugins: `tools/make_p3dx_meshes.py [folder]`.

Public robots refer to package://gazebo_plugins/test/multi_robot_scenario/meshes: the parts of a
Pioneer 3-DX and a Hokuyo laser. These have their names, extents [m] and axes; the shapes are ours.
"""

import math
import struct
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
    loft,
    moved,
    prism,
    rectangle,
)

FOLDER = (
    Path(__file__).resolve().parents[1]
    / 'companions'
    / 'gazebo_plugins'
    / 'test'
    / 'multi_robot_scenario'
    / 'meshes'
)
BLACK, GREY = Colour('black', (0.02, 0.02, 0.02)), Colour('grey', (0.7, 0.7, 0.7))


def about_y(*rims: tuple[float, float], sides: int = 24) -> Surface:
    """Return a solid of revolution about y through rims (radius, y)."""
    surface = loft([at_height(circle(radius, sides), y) for radius, y in rims])
    return along_first_axis(along_first_axis(surface))


def chassis() -> Surface:
    """Return the body: below narrower at both ends, above as long as the deck."""
    side = np.array(
        [
            (-0.17, -0.0861),
            (0.177, -0.0861),
            (0.2149, 0.036),
            (0.2149, 0.0861),
            (-0.2149, 0.0861),
            (-0.2149, 0.036),
        ]
    )
    outline = np.column_stack([side[:, 1], side[:, 0]])[::-1]  # z and x; extruded along y
    surface = prism(outline, -0.1386, 0.1386)
    return surface[:, :, [1, 2, 0]]


def bow(width: float, depth: float, sign: float) -> Array:
    """Return the outline of half an ellipse that bulges towards x times `sign`, centred in x."""
    angles = np.linspace(-math.pi / 2.0, math.pi / 2.0, 17)
    x = sign * depth * (np.cos(angles) - 0.5)
    outline = np.column_stack([x, width / 2.0 * np.sin(angles)])
    return outline if sign > 0.0 else outline[::-1]


def rim(sign: float) -> Surface:
    """Return the frame of a row of sonars: two plates."""
    outline = bow(0.275, 0.123, sign)
    return np.concatenate([prism(outline, low, low + 0.006) for low in (-0.0197, 0.0137)])


def sonar(sign: float) -> Surface:
    """Return a row of sonars."""
    return prism(bow(0.2758, 0.1222, sign), -0.0185, 0.0185)


def swivel() -> Surface:
    """Return the fork of the rear wheel: a plate above, two cheeks down and backwards."""
    plate = block((-0.0277, -0.0323, 0.0227), (0.0367, 0.0323, 0.0277))
    cheek = np.array([(-0.0367, -0.0277), (-0.015, -0.0277), (0.0367, 0.0227), (-0.0277, 0.0227)])
    wall = prism(np.column_stack([cheek[:, 1], cheek[:, 0]])[::-1], 0.0, 0.005)[:, :, [1, 2, 0]]
    return np.concatenate(
        [plate, moved(wall, (0.0, 0.0224, 0.0)), moved(wall, (0.0, -0.0274, 0.0))]
    )


def top() -> Surface:
    """Return the deck."""
    return prism(rectangle((-0.2211, -0.1906), (0.2211, 0.1906), 0.06, 4), -0.0026, 0.0026)


def hokuyo() -> list[tuple[Colour, Surface]]:
    """Return a laser scanner: a box below, its window and cap above."""
    return [
        (BLACK, block((-0.025, -0.025, -0.035), (0.025, 0.025, 0.0), 0.002)),
        (GREY, prism(circle(0.02, 20), 0.0, 0.02)),
        (BLACK, prism(circle(0.022, 20), 0.02, 0.035, 0.002)),
    ]


HUB = ((0.0525, -0.0147), (0.0525, 0.0), (0.03, 0.0153))
PARTS = {
    'back_rim': rim(-1.0),
    'back_sonar': sonar(-1.0),
    'center_hubcap': about_y((0.016, -0.021), (0.016, 0.021), sides=12),
    'center_wheel': about_y((0.03, -0.0159), (0.0382, -0.008), (0.0382, 0.008), (0.03, 0.0159)),
    'chassis': chassis(),
    'front_rim': rim(1.0),
    'front_sonar': sonar(1.0),
    'left_hubcap': about_y(*[(radius, -y) for radius, y in reversed(HUB)]),
    'left_wheel': about_y((0.08, -0.0203), (0.0913, -0.012), (0.0913, 0.012), (0.08, 0.0203)),
    'right_hubcap': about_y(*HUB),
    'right_wheel': about_y((0.08, -0.0203), (0.0913, -0.012), (0.0913, 0.012), (0.08, 0.0203)),
    'swivel': swivel(),
    'top': top(),
}


def stl(surface: Surface) -> bytes:
    """Return a binary STL file."""
    normals = np.cross(surface[:, 1] - surface[:, 0], surface[:, 2] - surface[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    facets = np.concatenate([normals[:, None], surface], axis=1).astype('<f4')
    return (
        b'tools/make_p3dx_meshes.py'.ljust(80)
        + struct.pack('<I', len(facets))
        + b''.join(facet.tobytes() + b'\0\0' for facet in facets)
    )


def main(arguments: list[str]) -> int:
    """Write every mesh to the folder named by the first argument; return the exit code."""
    folder = Path(arguments[0]) if arguments else FOLDER
    for name in ('p3dx', 'laser'):
        (folder / name).mkdir(parents=True, exist_ok=True)
    for name, surface in PARTS.items():
        (folder / 'p3dx' / f'{name}.stl').write_bytes(stl(surface))
    (folder / 'laser' / 'hokuyo.dae').write_text(
        collada('hokuyo', hokuyo(), tool='tools/make_p3dx_meshes.py'), encoding='utf-8'
    )
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
