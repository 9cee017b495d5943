"""What is selected: by clicks, in each browser, and no longer than it exists."""

import pytest
from support.window import clock, model, selection

from rosbots_description.sim.core import Pose
from rosbots_description.sim.description import Plane, SceneChange, ShownModel
from rosbots_description.web.scene import views
from rosbots_description.web.scene.models import Models

CLICK = '/models/a/link/0 v'
BOX = '/models/a/link/selected'


def two_links(number):
    return model('a', number, links=('link', 'other'))


def test_a_click_selects_the_model_and_a_second_one_its_link(
    browser, simulator, page, site, monkeypatch
):
    monkeypatch.setattr(views, 'DOUBLE', 0.0)
    simulator.change(SceneChange(True, (two_links(1), model('b', 3))))
    browser.click_node(CLICK)
    browser.wait_until(lambda: BOX in browser.nodes)
    browser.wait_until(lambda: '/models/a/other/selected' in browser.nodes)
    assert (selection(page).model, selection(page).link) == ('a', None)
    browser.click_node(CLICK)
    browser.wait_until(lambda: '/models/a/other/selected' not in browser.nodes)
    assert (selection(page).model, selection(page).link) == ('a', 'link')
    browser.press('escape')
    browser.wait_until(lambda: BOX not in browser.nodes)
    assert selection(page).model is None


def test_the_box_is_around_what_is_seen(browser, client, simulator, page):
    simulator.change(SceneChange(True, (model('a', 1),)))
    selection(page).choose('a')
    points = client.scene.get_handle_by_name(BOX).points.reshape(-1, 3)
    assert points.min(axis=0) == pytest.approx([-0.5, -0.5, 0.5], abs=0.02)
    assert points.max(axis=0) == pytest.approx([0.5, 0.5, 1.5], abs=0.02)


def test_grounds_take_no_clicks(browser, simulator):
    simulator.change(SceneChange(True, (model('a', 1), model('ground', 2, Plane()))))
    browser.wait_until(lambda: '/models/ground/link/0 v/grid' in browser.nodes)
    bindings = browser.received('SetSceneNodeClickBindingsMessage')
    assert {m['name'] for m in bindings if m['bindings']} == {CLICK}


def test_it_survives_a_simulator_that_numbers_anew_and_a_model_that_changes(
    browser, simulator, page
):
    simulator.change(SceneChange(True, (two_links(1),)))
    selection(page).choose('a', 'other')
    simulator.change(SceneChange(True, (two_links(7),)))
    simulator.change(SceneChange(models=(two_links(9),), removed=('a',)))
    assert (selection(page).model, selection(page).link) == ('a', 'other')
    simulator.change(SceneChange(models=(model('a', 11, Plane()),), removed=('a',)))
    assert (selection(page).model, selection(page).link) == ('a', None)
    simulator.change(SceneChange(models=(model('a', 12),), removed=('a',)))
    browser.wait_until(lambda: BOX in browser.nodes)  # it was drawn again


def test_it_ends_when_the_model_goes(browser, simulator, page):
    seen = []
    selection(page).on_change(lambda: seen.append(selection(page).model))
    simulator.change(SceneChange(True, (model('a', 1), model('b', 2))))
    selection(page).choose('a')
    selection(page).choose('a')
    simulator.change(SceneChange(removed=('a',)))
    selection(page).choose('nobody')
    selection(page).choose('b', 'no link')
    assert (selection(page).model, selection(page).link) == ('b', None)
    simulator.change(SceneChange(True))
    assert seen == ['a', None, 'b', None]


def test_models_know_where_they_are():
    models = Models()
    links = model('a', 1, position=(1.0, 0.0, 3.0)).links
    models.apply(SceneChange(True, (ShownModel('a', links, canonical_pose=Pose((0.0, 0.0, 1.0))),)))
    assert models.pose('a') == Pose((1.0, 0.0, 2.0))
    models.move(clock(_1=Pose((5.0, 0.0, 3.0)), _2=Pose()))
    assert models.pose('a') == Pose((5.0, 0.0, 2.0))
    models.apply(SceneChange(removed=('a',)))
    assert models.all == {}


def test_what_is_expected_is_selected_when_it_comes(simulator, page, browser):
    simulator.change(SceneChange(True, (model('a', 1),)))
    selection(page).choose('a')
    selection(page).expect('b')
    assert selection(page).model == 'a'
    simulator.change(SceneChange(models=(model('c', 2),)))
    assert selection(page).model == 'a'
    simulator.change(SceneChange(models=(model('b', 3),)))
    assert selection(page).model == 'b'
    selection(page).expect('c')
    assert selection(page).model == 'c'


def test_another_choice_ends_the_expectation(simulator, page, browser):
    simulator.change(SceneChange(True, (model('a', 1),)))
    selection(page).expect('b')
    selection(page).choose('a')
    simulator.change(SceneChange(models=(model('b', 2),)))
    assert selection(page).model == 'a'
