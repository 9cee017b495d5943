"""Goals and initial poses by two clicks, in the frame of the robot's map."""

import math
import re

import pytest
from support.browser import Browser
from support.window import FakeGoals

from rosbots_description.sim.core import Pose, from_rpy, to_rpy
from rosbots_description.sim.description import SceneChange, ShownLink, ShownModel
from rosbots_description.web.goals import ESTIMATE, GOAL, GoalPanel
from rosbots_description.web.ground_clicks import GroundClicks
from rosbots_description.web.models import Models

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
def notices():
    return []


@pytest.fixture
def panel(site, goals, notices):
    models = Models()
    models.apply(
        SceneChange(True, (ShownModel('robot', (ShownLink(1, 'base', Pose((2.0, 0.0, 0.0))),)),))
    )
    panel = GoalPanel(site.gui, goals, models, GroundClicks(site), notices.append)
    panel.refresh()
    return panel


@pytest.fixture
def browser(site, panel):
    with Browser(site.address) as browser:
        browser.wait_until(lambda: browser.control(GOAL))
        yield browser


def asks(browser, sentence):
    browser.wait_until(lambda: any(sentence in note for note in browser.notes()))


def click(browser, label, *points):
    browser.click(label)
    for (x, y), sentence in zip(points, ('click on the ground', 'Now click'), strict=True):
        asks(browser, sentence)
        browser.click_ray([x, y, 5.0], DOWN)


@pytest.mark.parametrize(
    ('label', 'kind', 'topic'), [(GOAL, 'goal', TOPIC), (ESTIMATE, 'estimate', INITIAL)]
)
def test_two_clicks_are_a_place_and_a_heading_in_the_map(
    browser, goals, notices, label, kind, topic
):
    click(browser, label, (1.0, 3.0), (1.0, 7.0))
    browser.wait_until(lambda: goals.sent)
    ((sent, to, frame, pose),) = goals.sent
    assert (sent, to, frame) == (kind, topic, 'map')
    assert pose.position == pytest.approx((3.0, 0.0, 0.0))  # ahead of the map's origin
    assert to_rpy(pose.orientation) == pytest.approx((0.0, 0.0, 0.0))
    browser.wait_until(lambda: notices)
    assert re.fullmatch(rf"{topic}: x 3\.00 m, y -?0\.00 m, yaw -?0\.00 rad in 'map'", notices[0])


def test_the_first_point_is_marked_until_the_second_is_known(browser, goals):
    browser.click(GOAL)
    asks(browser, 'click on the ground')
    browser.click_ray([1.0, 2.0, 5.0], DOWN)
    browser.wait_until(
        lambda: (
            [state[1] for node, state in browser.nodes.items() if node.startswith('/clicked/')]
            == [[1.0, 2.0, 0.0]]
        )
    )
    asks(browser, 'Now click')
    browser.click_ray([2.0, 2.0, 5.0], DOWN)
    browser.wait_until(
        lambda: goals.sent and not any(node.startswith('/clicked/') for node in browser.nodes)
    )


def test_without_a_map_the_pose_is_in_odom(browser, goals):
    goals.frames['odom'] = goals.frames.pop('map')
    click(browser, GOAL, (1.0, 3.0), (1.0, 7.0))
    browser.wait_until(lambda: goals.sent)
    assert goals.sent[0][2] == 'odom'


def test_without_tf_nothing_is_sent_and_the_reason_told(browser, goals, notices):
    goals.frames.clear()
    click(browser, GOAL, (1.0, 3.0), (1.0, 7.0))
    browser.wait_until(lambda: notices)
    assert 'TF connects neither map nor odom with a robot' in notices[0]
    assert goals.sent == []


def test_a_goal_that_nobody_takes_any_more_is_refused(browser, goals, panel, notices):
    browser.click(GOAL)
    asks(browser, 'click on the ground')
    goals.goals = ()
    panel.refresh()
    browser.click_ray([1.0, 2.0, 5.0], DOWN)
    asks(browser, 'Now click')
    browser.click_ray([2.0, 2.0, 5.0], DOWN)
    browser.wait_until(lambda: notices)
    assert notices == ['nobody takes a 2D Nav Goal any more']
    assert goals.sent == []


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
