"""Shadow maps are read only where shadows may fall, and nothing is missed."""

from dataclasses import dataclass

import numpy as np
import pytest

from rosbots_description.sim.core.transforms import from_rpy
from rosbots_description.sim.rendering.gl.cameras import camera_view, matrices, projection
from rosbots_description.sim.rendering.gl.shadows import Sweeps
from rosbots_description.sim.rendering.gl.values import Lens

LIGHT = np.array([-0.5, 0.1, -0.9]) / np.linalg.norm([-0.5, 0.1, -0.9])
GROUND = np.zeros(3), np.array([0.0, 0.0, 1.0])
SIZE = 320, 240


@dataclass
class Box:
    middle: np.ndarray
    half: np.ndarray

    @property
    def radius(self):
        return float(np.linalg.norm(self.half))

    @property
    def corners(self):
        return self.middle + self.half * [[x, y, z] for x in (-1, 1) for y in (-1, 1)
                                          for z in (-1, 1)]


@pytest.fixture
def boxes():
    draw = np.random.default_rng(7)
    return [Box(draw.uniform((-2, -3, 0.3), (5, 3, 1.5)), draw.uniform(0.05, 1.0, 3))
            for _ in range(12)]


def points_of(boxes):
    draw = np.random.default_rng(8)
    return np.concatenate([box.middle + draw.uniform(-1, 1, (500, 3)) * box.half for box in boxes])


@pytest.mark.parametrize('pitch', [-0.2, 0.1, 0.6, 1.5])
def test_rectangles_hold_all_shadows_on_the_ground_that_a_camera_sees(boxes, pitch):
    eye = matrices(np.array([[0.0, 0.0, 0.5, *from_rpy(0.0, pitch, 0.4)]]))[0]
    view = projection(Lens(*SIZE, 1.4, 0.1, 100.0)) @ camera_view(eye)
    rectangles = Sweeps(boxes, LIGHT, 0.0).rectangles(GROUND, view, SIZE)
    points = points_of(boxes)
    shadows = points - points[:, 2:] / LIGHT[2] * LIGHT
    x, y, _, depth = view[:, :3] @ shadows.T + view[:, 3:]
    column, row = ((c / depth + 1.0) / 2.0 * n for c, n in zip((x, y), SIZE, strict=True))
    seen = (depth > 0.1) & (column > 0) & (column < SIZE[0]) & (row > 0) & (row < SIZE[1])
    held = np.zeros(len(points), bool)
    for left, top, width, height in rectangles:
        held |= (column >= left) & (column <= left + width) & (row >= top) & (row <= top + height)
    assert held[seen].all()
    assert seen.any() or pitch < 0.0


def test_a_shadow_reaches_the_sphere_into_which_it_falls(boxes):
    along = np.random.default_rng(9).uniform(0.0, 1.0, 6000)
    points = points_of(boxes)
    lower = points + along[:, None] * (-points[:, 2:] / LIGHT[2]) * LIGHT
    sweeps = Sweeps(boxes, LIGHT, 0.0)
    assert all(sweeps.reach(point, 0.01) for point in lower)
    assert not sweeps.reach(np.array([0.0, 20.0, 0.0]), 1.0)
    assert not sweeps.reach(np.array([3.0, 0.0, 9.0]), 1.0)  # above all of them
