"""Goals and initial poses by two clicks, in the frame of the robot's map."""

import math
import re

import pytest
from support.window import FakeGoals, model, models_with

from rosbots_description.sim.core import Pose, from_rpy, to_rpy
from rosbots_description.web.panels.goals import ESTIMATE, GOAL, GoalPanel
from rosbots_description.web.scene.ground_clicks import GroundClicks

TOPIC, INITIAL = '/move_base_simple/goal', '/initialpose'
DOWN = (0.0, 0.0, -1.0)


@pytest.fixture
def goals():
    goals = FakeGoals()
    goals.goals, goals.estimates = (TOPIC,), (INITIAL,)
    # The map is a quarter turn to the left of the world, from (1, 0) on.
    goals.frames['map'] = 'base', Pose((-1.0, 0.0, 0.0), from_rpy(0.0, 0.0, math.pi / 2.0))
    return goals


@pytest.fixture
def panel(site, goals, complaints):
    models = models_with(model('robot', 1, position=(2.0, 0.0, 0.0), links=('base',)))
    panel = GoalPanel(site.gui, goals, models, GroundClicks(site), complaints.append)
    panel.refresh()
    return panel


def asks(browser, sentence):
    browser.wait_until(lambda: browser.noted(sentence))


def marks(browser):
    """Return the positions of the points that are marked."""
    return [state[1] for node, state in browser.nodes.items() if node.startswith('/clicked/')]


def click(browser, label, *points):
    browser.click(label)
    for (x, y), sentence in zip(points, ('click on the ground', 'Now click'), strict=True):
        asks(browser, sentence)
        browser.click_ray([x, y, 5.0], DOWN)


@pytest.mark.parametrize(
    ('label', 'kind', 'topic'), [(GOAL, 'send_goal', TOPIC), (ESTIMATE, 'send_estimate', INITIAL)]
)
def test_two_clicks_are_a_place_and_a_heading_in_the_map(
    browser, goals, complaints, label, kind, topic
):
    click(browser, label, (1.0, 3.0), (1.0, 7.0))
    browser.wait_until(lambda: goals.told)
    ((sent, to, frame, pose),) = goals.told
    assert (sent, to, frame) == (kind, topic, 'map')
    assert pose.position == pytest.approx((3.0, 0.0, 0.0))  # ahead of the map's origin
    assert to_rpy(pose.orientation) == pytest.approx((0.0, 0.0, 0.0))
    browser.wait_until(lambda: complaints)
    assert re.fullmatch(
        rf"{topic}: x 3\.00 m, y -?0\.00 m, yaw -?0\.00 rad in 'map'", complaints[0]
    )


def test_the_first_point_is_marked_until_the_second_is_known(browser, goals):
    browser.click(GOAL)
    asks(browser, 'click on the ground')
    browser.click_ray([1.0, 2.0, 5.0], DOWN)
    browser.wait_until(lambda: marks(browser) == [[1.0, 2.0, 0.0]])
    asks(browser, 'Now click')
    browser.click_ray([2.0, 2.0, 5.0], DOWN)
    browser.wait_until(lambda: goals.told and not marks(browser))


def test_without_a_map_the_pose_is_in_odom(browser, goals):
    goals.frames['odom'] = goals.frames.pop('map')
    click(browser, GOAL, (1.0, 3.0), (1.0, 7.0))
    browser.wait_until(lambda: goals.told)
    assert goals.told[0][2] == 'odom'


def test_without_tf_nothing_is_sent_and_the_reason_told(browser, goals, complaints):
    goals.frames.clear()
    click(browser, GOAL, (1.0, 3.0), (1.0, 7.0))
    browser.wait_until(lambda: complaints)
    assert 'TF connects neither map nor odom with a robot' in complaints[0]
    assert goals.told == []


def test_a_goal_that_nobody_takes_any_more_is_refused(browser, goals, panel, complaints):
    browser.click(GOAL)
    asks(browser, 'click on the ground')
    goals.goals = ()
    panel.refresh()
    browser.click_ray([1.0, 2.0, 5.0], DOWN)
    asks(browser, 'Now click')
    browser.click_ray([2.0, 2.0, 5.0], DOWN)
    browser.wait_until(lambda: complaints)
    assert complaints == ['nobody takes a 2D Nav Goal any more']
    assert goals.told == []


def test_buttons_are_there_while_somebody_takes_poses(browser, goals, panel):
    def shown():
        return [
            label
            for label in (GOAL, ESTIMATE)
            if browser.controls[browser.parents[browser.control(label)]][1]['visible']
        ]

    assert shown() == [GOAL, ESTIMATE]
    goals.goals = ()
    panel.refresh()
    browser.wait_until(lambda: shown() == [ESTIMATE])


def test_tf_is_heard_from_the_button_until_all_browsers_have_left(browser, goals, panel):
    assert not goals.is_listening
    browser.click(GOAL)
    browser.wait_until(lambda: goals.is_listening)
    panel.close()
    assert not goals.is_listening
