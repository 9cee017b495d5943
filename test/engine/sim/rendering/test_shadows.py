"""Shadow maps are read only where shadows may fall, and nothing is missed."""

from dataclasses import dataclass

import numpy as np
import pytest

from rosbots_description.sim.core.transforms import from_rpy
from rosbots_description.sim.rendering.gl import shadows
from rosbots_description.sim.rendering.gl.cameras import (
    camera_view,
    matrices,
    projection,
    view_corners,
)
from rosbots_description.sim.rendering.gl.context import open_context
from rosbots_description.sim.rendering.gl.drawable import Frame
from rosbots_description.sim.rendering.gl.renderer import Renderer
from rosbots_description.sim.rendering.gl.shadows import Sweeps
from rosbots_description.sim.rendering.gl.values import (
    DIRECTIONAL,
    Appearance,
    Lens,
    Light,
    Scene,
    ScenePart,
)
from rosbots_description.sim.rendering.shapes import unit_box, unit_square

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
    def arms(self):
        return np.diag(self.half)


@pytest.fixture
def boxes():
    draw = np.random.default_rng(7)
    return [
        Box(draw.uniform((-2, -3, 0.3), (5, 3, 1.5)), draw.uniform(0.05, 1.0, 3)) for _ in range(12)
    ]


def points_of(boxes):
    draw = np.random.default_rng(8)
    return np.concatenate([box.middle + draw.uniform(-1, 1, (500, 3)) * box.half for box in boxes])


@pytest.mark.parametrize('pitch', [-0.2, 0.1, 0.6, 1.5])
def test_rectangles_hold_all_shadows_on_the_ground_that_a_camera_sees(boxes, pitch):
    eye = matrices(np.array([[0.0, 0.0, 0.5, *from_rpy(0.0, pitch, 0.4)]]))[0]
    view = projection(Lens(*SIZE, 1.4, 0.1, 100.0)) @ camera_view(eye)
    rectangles = Sweeps(boxes, LIGHT, 0.0).rectangles(GROUND, view, SIZE)
    points = points_of(boxes)
    fallen = points - points[:, 2:] / LIGHT[2] * LIGHT
    x, y, _, depth = view[:, :3] @ fallen.T + view[:, 3:]
    column, row = ((c / depth + 1.0) / 2.0 * n for c, n in zip((x, y), SIZE, strict=True))
    seen = (depth > 0.1) & (column > 0) & (column < SIZE[0]) & (row > 0) & (row < SIZE[1])
    held = np.zeros(len(points), bool)
    for left, top, width, height in rectangles:
        held |= (column >= left) & (column <= left + width) & (row >= top) & (row <= top + height)
    assert held[seen].all()
    assert seen.any() or pitch < 0.0


@pytest.mark.parametrize('pitch', [-0.2, 0.1, 0.6, 1.5])
def test_what_casts_a_shadow_that_a_camera_sees_is_seen(boxes, pitch):
    eye = matrices(np.array([[0.0, 0.0, 0.5, *from_rpy(0.0, pitch, 0.4)]]))[0]
    lens = Lens(*SIZE, 1.0, 0.1, 100.0)
    frame = Frame(lens, eye, projection(lens) @ camera_view(eye), np.zeros((0, 4, 4)))
    sweeps = Sweeps(boxes, LIGHT, 0.0)
    seen = {id(one) for one in sweeps.seen(frame.planes)}
    unseen = [box for box in boxes if id(box) not in seen]
    points = points_of(unseen) if unseen else np.zeros((0, 3))
    for share in (0.0, 0.3, 1.0):
        fallen = points - share * points[:, 2:] / LIGHT[2] * LIGHT
        assert not ((fallen @ frame.planes[:, :3].T + frame.planes[:, 3]) > 0.0).all(axis=1).any()
    assert 0 < len(unseen) < len(boxes)


def test_a_shadow_reaches_the_sphere_into_which_it_falls(boxes):
    along = np.random.default_rng(9).uniform(0.0, 1.0, 6000)
    points = points_of(boxes)
    lower = points + along[:, None] * (-points[:, 2:] / LIGHT[2]) * LIGHT
    sweeps = Sweeps(boxes, LIGHT, 0.0)
    assert sweeps.reach(lower, np.full(len(lower), 0.01)).all()
    beside_and_above = np.array([[0.0, 20.0, 0.0], [3.0, 0.0, 9.0]])
    assert not sweeps.reach(beside_and_above, np.ones(2)).any()
    assert not Sweeps([], LIGHT, 0.0).reach(beside_and_above, np.ones(2)).any()


@pytest.mark.parametrize('field_of_view', [0.3, 1.4, 3.0])
def test_what_a_camera_sees_is_within_the_hull_of_five_points(field_of_view):
    lens = Lens(*SIZE, field_of_view, 0.1, 20.0)
    eye = matrices(np.array([[1.0, -2.0, 0.5, *from_rpy(0.2, 0.6, 2.0)]]))[0]
    ways = (
        np.random.default_rng(10).uniform(-1.0, 1.0, (500, 2))
        * np.tan(field_of_view / 2.0)
        * (1.0, SIZE[1] / SIZE[0])
    )
    reach = np.random.default_rng(11).uniform(0.1, 20.0, 500)
    points = eye[:3, 3] + reach[:, None] * (np.insert(ways, 0, 1.0, axis=1) @ eye[:3, :3].T)
    hull = view_corners(eye, lens)
    for axis in np.random.default_rng(12).normal(size=(20, 3)):
        assert (points @ axis).min() >= (hull @ axis).min() - 1e-9
        assert (points @ axis).max() <= (hull @ axis).max() + 1e-9


@pytest.mark.parametrize('yaw', [0.0, 0.8, 2.4, 4.0])
def test_a_shadow_map_without_what_no_picture_shows_gives_the_same_picture(monkeypatch, yaw):
    """Plates like the decks of a robot, the camera at their front edge."""
    renderer = Renderer(open_context()[0])
    renderer.add_mesh('box', np.asarray(unit_box()).reshape(-1, 8))
    renderer.add_mesh('ground', np.asarray(unit_square((0.0, 0.0, 1.0))).reshape(-1, 8))
    draw = np.random.default_rng(13)
    poses = np.zeros((9, 7))
    poses[:, 3:] = from_rpy(0.0, 0.0, yaw)
    x, y, z = draw.uniform((-0.7, -0.3, 0.2), (-0.3, 0.3, 0.9), (8, 3)).T
    poses[1:, :3] = np.stack(
        (x * np.cos(yaw) - y * np.sin(yaw), x * np.sin(yaw) + y * np.cos(yaw), z), axis=1
    )
    look = Appearance((0.8,) * 3, (0.8,) * 3, (0.0,) * 3, 0.0, (0.0,) * 3, 1.0)
    renderer.set_scene(
        Scene(
            (
                ScenePart(
                    'ground', 0, np.diag((50.0, 50.0, 1.0, 1.0)).tobytes(), look, False, True
                ),
                *(
                    ScenePart('box', body, np.diag((1.0, 1.0, 0.05, 1.0)).tobytes(), look)
                    for body in range(1, 9)
                ),
            ),
            (
                Light(
                    DIRECTIONAL,
                    (0.0, 0.0, 5.0),
                    tuple(LIGHT.tolist()),
                    (0.8,) * 3,
                    (0.0,) * 3,
                    100.0,
                    (1.0, 0.0, 0.0),
                    (1.0, 0.0, 1.0),
                    True,
                ),
            ),
        )
    )
    eye = np.array([0.0, 0.0, 0.7, *from_rpy(0.0, 0.5, yaw)])
    lens = Lens(*SIZE, 1.04, 0.1, 50.0)
    cut = renderer.colours(lens, eye, poses).copy()
    (one,) = renderer._shadows._moving.values()
    _, _, width, height = one._buffer.scissor
    monkeypatch.setattr(shadows, 'view_corners', lambda *_: np.array([[-1e3] * 3, [1e3] * 3]))
    whole = renderer.colours(lens, eye, poses)
    assert one._buffer.scissor == (0, 0, one.size, one.size)
    assert np.array_equal(cut, whole)
    assert yaw > 0.0 or width * height < 0.7 * one.size**2  # the sun is ahead on the left
    assert cut[..., 0].min() < 100  # shade
    assert cut[..., 0].max() > 200  # light
