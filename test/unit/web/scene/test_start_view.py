"""The page begins with everything in view, and not from behind a wall."""

import numpy as np
import pytest
from support.window import model

from rosbots_description.sim.core import Pose, from_rpy
from rosbots_description.sim.description import Box, Plane, SceneChange, SceneSpec, ShownMotion
from rosbots_description.web.scene.models import Models
from rosbots_description.web.scene.start_view import StartView


@pytest.fixture
def view():
    return StartView(Models())


def take_in(view, *models, camera=None):
    for panel in (view._models, view):
        panel.apply(SceneChange(True, models, scene=SceneSpec(user_camera=camera)))


def show(view, *models, camera=None):
    take_in(view, *models, camera=camera)
    return view.choose()


def test_everything_is_looked_at_from_above_and_grounds_are_not(view):
    eye, target = show(
        view,
        model('ground', 1, Plane()),
        model('box', 2, position=(99.0, 0.0, 0.0)),
        model('other', 3, position=(101.0, 0.0, 0.0)),
    )
    assert target == pytest.approx((100.0, 0.0, 1.0))
    assert 2.0 < eye[2] < 3.0
    assert eye[0] > 101.0 and eye[1] < -1.0  # from ahead at the right


def test_links_are_where_they_have_moved(view):
    take_in(view, model('box', 2))
    view._models.move(ShownMotion(0.0, 0.0, 0, False, {2: Pose((5.0, 0.0, 0.0))}))
    assert view.choose()[1] == pytest.approx((5.0, 0.0, 1.0))


@pytest.mark.parametrize('yaw', [0.0, 0.4])
def test_the_view_is_not_from_behind_a_wall(view, yaw):
    box, wall = model('box', 1, Box((0.2, 0.2, 0.2))), model('wall', 2, Box((0.1, 20.0, 6.0)))
    take_in(view, box, wall)
    turned = Pose((1.0, 0.0, 0.0), from_rpy(0.0, 0.0, yaw))
    view._models.move(ShownMotion(0.0, 0.0, 0, False, {2: turned}))
    eye, _ = view.choose()
    normal = np.array([np.cos(yaw), np.sin(yaw), 0.0])  # of the wall
    side, side_of_box = (normal @ np.subtract(one, turned.position) for one in (eye, (0, 0, 1)))
    assert side * side_of_box > 0.0


def test_where_everything_is_hidden_from_everywhere_some_view_is_chosen(view):
    eye, target = show(
        view, model('box', 1, Box((0.2, 0.2, 0.2))), model('shell', 2, Box((4.0, 4.0, 4.0)))
    )
    assert np.linalg.norm(np.subtract(eye, target)) > 4.0


def test_a_world_without_anything_has_a_view(view):
    eye, target = show(view)
    assert target == (0.0, 0.0, 0.0) and np.linalg.norm(eye) > 1.0


def test_a_camera_of_the_world_is_the_view(view):
    camera = Pose((4.0, 0.0, 1.0), from_rpy(0.0, 0.0, np.pi))
    eye, target = show(view, model('box', 1), camera=camera)
    assert eye == (4.0, 0.0, 1.0)
    assert target == pytest.approx((0.0, 0.0, 1.0))
    away = Pose((4.0, 0.0, 1.0))
    assert show(view, model('box', 1), camera=away)[1] == pytest.approx((5.0, 0.0, 1.0))


def test_the_view_stays_the_same_until_a_model_comes(view):
    first = show(view, model('box', 2))
    view._models.move(ShownMotion(0.0, 0.0, 0, False, {2: Pose((5.0, 0.0, 0.0))}))
    assert view.choose() == first
    assert show(view, model('box', 2)) == first  # the page was closed and opened again
    assert show(view, model('box', 2), model('other', 3, position=(9.0, 0.0, 0.0))) != first


def test_a_picture_that_is_narrow_is_seen_from_further_away(view):
    eye, target = map(np.array, show(view, model('box', 2)))
    assert view.choose(2.0) == (tuple(eye), tuple(target))
    narrow, same = view.choose(0.5)
    assert narrow - target == pytest.approx(2.0 * (eye - target))
    assert same == tuple(target)
