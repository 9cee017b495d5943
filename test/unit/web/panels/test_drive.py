"""Driving: keys and buttons in a browser become commands, and end when they are let go."""

import pytest
from support.window import FakeSimulator

from rosbots_description.web.controls.camera_keys import CameraKeys
from rosbots_description.web.panels import drive
from rosbots_description.web.panels.drive import DrivePanel, VelocityCommands

STOP = ('drive', '/b/cmd_vel', 0.0, 0.0)


@pytest.fixture
def robots():
    robots = FakeSimulator()
    robots.topics = ('/a/cmd_vel', '/b/cmd_vel')
    return robots


@pytest.fixture
def panel(site, robots):
    return DrivePanel(
        site.gui,
        VelocityCommands(robots),
        robots.drive_topics,
        CameraKeys(site.gui),
        site.allow_viewers,
    )


def choose_second(browser, panel):
    panel.refresh()
    browser.choose('Topic', '/b/cmd_vel')


def pages_html(browser):
    """Return what the page is given as HTML."""
    return browser.contents()[0]


def folder_is_visible(browser):
    return browser.props('Drive')['visible']


def test_nothing_drives_before_there_is_a_topic(browser, robots):
    browser.press('I')
    browser.read(0.2)
    assert robots.told == []
    assert not folder_is_visible(browser)


def test_a_key_drives_and_the_robot_stops_by_itself(browser, robots, panel, monkeypatch):
    monkeypatch.setattr(drive, 'HOLD', 0.1)
    choose_second(browser, panel)
    browser.choose('Turn [rad/s]', 2.0)
    browser.press('arrowleft')
    browser.wait_until(lambda: len(robots.told) == 2)
    assert robots.told == [('drive', '/b/cmd_vel', 0.0, 2.0), STOP]


def test_a_held_button_goes_on_and_stop_ends_it_once(browser, robots, panel, monkeypatch):
    monkeypatch.setattr(drive, 'HOLD', 5.0)
    choose_second(browser, panel)
    for count in range(1, 6):
        browser.hold('Backward')
        browser.wait_until(lambda count=count: len(robots.told) == count)
    assert robots.told == [('drive', '/b/cmd_vel', -0.5, 0.0)] * 5
    end = panel._velocities._ends['/b/cmd_vel']
    browser.press('K')
    browser.wait_until(lambda: robots.told[-1] == STOP)
    end.join(timeout=60.0)  # it was cancelled: it sends nothing more
    assert len(robots.told) == 6


def test_a_robot_that_is_no_longer_chosen_stops_too(browser, robots, panel, monkeypatch):
    monkeypatch.setattr(drive, 'HOLD', 0.5)
    choose_second(browser, panel)
    browser.press('I')
    browser.wait_until(lambda: robots.told)
    browser.choose('Topic', '/a/cmd_vel')
    browser.press('I')
    browser.wait_until(lambda: len(robots.told) == 4)
    assert sorted(robots.told) == [
        ('drive', '/a/cmd_vel', 0.0, 0.0),
        ('drive', '/a/cmd_vel', 0.5, 0.0),
        STOP,
        ('drive', '/b/cmd_vel', 0.5, 0.0),
    ]


@pytest.mark.parametrize(
    ('key', 'ahead', 'left'),
    [
        *[('U', 1, 1), ('I', 1, 0), ('O', 1, -1)],
        *[('J', 0, 1), ('L', 0, -1)],
        *[('.', -1, 1), (',', -1, 0), ('M', -1, -1)],
        *[('W', 1, 0), ('A', 0, 1), ('S', -1, 0), ('D', 0, -1)],
    ],
)
def test_keys_are_those_of_teleop_and_of_games(browser, robots, panel, key, ahead, left):
    choose_second(browser, panel)
    browser.press(key)
    browser.wait_until(lambda: robots.told)
    assert robots.told[0] == ('drive', '/b/cmd_vel', 0.5 * ahead, 1.0 * left)


def test_keys_of_the_camera_drive_only_if_there_is_something_to_drive(browser, robots, panel):
    choose_second(browser, panel)
    browser.wait_until(lambda: 'stopPropagation' in pages_html(browser))
    browser.wait_until(lambda: browser.idle_keys == set())
    browser.choose('W A S D and arrows drive', False)
    keys = {'W', 'A', 'S', 'D', 'arrowup', 'arrowdown', 'arrowleft', 'arrowright'}
    browser.wait_until(lambda: browser.idle_keys == keys)
    browser.wait_until(lambda: 'stopPropagation' not in pages_html(browser))
    browser.choose('W A S D and arrows drive', True)
    browser.wait_until(lambda: 'stopPropagation' in pages_html(browser))
    robots.topics = ()
    panel.refresh()
    browser.wait_until(lambda: 'stopPropagation' not in pages_html(browser))
    browser.wait_until(lambda: not folder_is_visible(browser))
