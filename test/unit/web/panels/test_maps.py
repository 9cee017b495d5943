"""Maps and what navigation publishes: where it is shown, and the true map."""

import math

import numpy as np
import pytest
from support.window import FakeMaps, clock, model, models_with

from rosbots_description.sim.core import Pose, from_rpy
from rosbots_description.sim.description import ShownGrid, ShownReading
from rosbots_description.web.panels.maps import MapPanel

MAP, NODE = '/map', '/readings/\u2215map'
GRID = ShownGrid(np.zeros((2, 4, 4), np.uint8), 0.5, Pose((-1.0, 2.0, 0.0), from_rpy(0, 0, 0.5)))


@pytest.fixture
def maps():
    maps = FakeMaps({MAP: 'nav_msgs/OccupancyGrid'})
    maps.place = 'base', Pose((-5.0, 0.0, 0.0))
    maps.readings[MAP] = ShownReading('map', grid=GRID, words='4 x 2 cells')
    return maps


@pytest.fixture
def models():
    return models_with(model('robot', 1, position=(6.0, 0.0, 0.0), links=('base',)))


@pytest.fixture
def panel(site, maps, models):
    panel = MapPanel(site, maps, models)
    panel.open()
    panel.refresh()
    yield panel
    panel.close()


def position(browser, node=NODE):
    return browser.nodes.get(node, [None, None])[1]


def test_a_map_lies_where_the_robot_takes_it_to_be(browser, maps, models):
    browser.choose(MAP, True)
    browser.wait_until(lambda: position(browser) == [1.0, 0.0, 0.0])
    browser.wait_until(lambda: '4 x 2 cells' in browser.texts())
    models.move(clock(_1=Pose((6.5, 0.0, 0.0))))
    browser.wait_until(lambda: position(browser) == [1.5, 0.0, 0.0])
    maps.place = 'base', Pose((-5.5, 0.0, 0.0))  # the robot has corrected where it is
    browser.wait_until(lambda: position(browser) == [1.0, 0.0, 0.0])


def test_a_map_covers_its_cells_from_its_origin_on(browser):
    browser.choose(MAP, True)
    grid = f'{NODE}/grid'
    browser.wait_until(lambda: position(browser, grid) not in (None, [0.0, 0.0, 0.0]))
    (message,) = browser.received('ImageMessage')
    assert (message['props']['render_width'], message['props']['render_height']) == (2.0, 1.0)
    # The centre is half of 2 m by 1 m from the origin, along axes that are turned by 0.5 rad.
    cos, sin = math.cos(0.5), math.sin(0.5)
    assert position(browser, grid)[:2] == pytest.approx(
        (-1.0 + cos - 0.5 * sin, 2.0 + sin + 0.5 * cos)
    )


def test_without_tf_a_map_is_the_worlds(browser, maps):
    maps.place = None
    browser.choose(MAP, True)
    browser.wait_until(lambda: browser.shows("TF does not connect its frame 'map' with a robot"))
    assert position(browser) == [0.0, 0.0, 0.0]
    maps.place = 'base', Pose((-5.0, 0.0, 0.0))  # TF was only late
    browser.wait_until(lambda: position(browser) == [1.0, 0.0, 0.0])
    browser.wait_until(lambda: '4 x 2 cells' in browser.texts())


def test_a_box_without_its_check_shows_nothing(browser, maps):
    browser.choose(MAP, True)
    browser.wait_until(lambda: NODE in browser.nodes)
    browser.choose(MAP, False)
    browser.wait_until(lambda: NODE not in browser.nodes)
    assert maps.open_topics == set()


def test_the_true_map_is_that_of_the_height(browser, maps):
    maps.truth = ShownReading(words='8 cells', grid=GRID)
    browser.choose('Height of the true map [m]', 0.5)
    browser.choose('true map', True)
    browser.wait_until(lambda: '8 cells' in browser.texts())
    assert maps.heights == [0.5]
    assert position(browser, '/readings/true map') == [0.0, 0.0, 0.0]
    browser.choose('true map', False)
    browser.wait_until(lambda: '/readings/true map' not in browser.nodes)


def test_a_true_map_that_cannot_be_told_is_a_sentence(browser, maps):
    maps.truth = 'the simulator does not answer'
    browser.choose('true map', True)
    browser.wait_until(lambda: 'the simulator does not answer' in browser.texts())
