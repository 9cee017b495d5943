"""The plot: curves are chosen, read while somebody looks, and drawn over simulated time."""

import time

import numpy as np
import pytest
from support.window import FakeSignals, clock

from rosbots_description.web.panels.plot import PlotPanel

SPEED, TRUTH = '/odom/twist/twist/linear/x', '/gazebo/model_states/twist[1]/linear/x'


@pytest.fixture
def signals():
    return FakeSignals({'/odom': ('twist/twist/linear/x', 'twist/twist/angular/z')})


@pytest.fixture
def panel(site, signals, complaints):
    panel = PlotPanel(site, signals, complaints.append)
    panel.open()
    panel.refresh()
    panel.move(clock(10.0))
    yield panel
    panel.close()


def add(browser, signals, *curves):
    for curve in curves:
        browser.choose('Curve', curve)
        browser.click('Add curve')
        browser.wait_until(lambda curve=curve: curve in signals.open_curves)
        browser.wait_until(lambda curve=curve: browser.control(curve))


def last_values(panel):
    """Return the newest value of each curve that is drawn."""
    return [float(values[-1]) for values in panel._plot.data[1:]]


def plots(browser):
    return [props for kind, props in browser.controls.values() if kind == 'GuiUplotMessage']


def test_a_curve_is_chosen_by_topic_and_field(browser, signals):
    browser.choose('Topic', '/odom')
    browser.wait_until(lambda: 'twist/twist/linear/x' in browser.props('Field')['options'])
    browser.choose('Field', 'twist/twist/linear/x')
    browser.wait_until(lambda: browser.value('Curve') == SPEED)
    browser.click('Add curve')
    browser.wait_until(lambda: signals.open_curves == {SPEED})
    assert signals.opened == [SPEED]


def test_curves_are_drawn_until_they_are_unchecked(browser, signals, panel):
    add(browser, signals, SPEED, TRUTH)
    browser.wait_until(lambda: len(plots(browser)) == 1)
    assert [series.get('label') for series in plots(browser)[0]['series']][1:] == [SPEED, TRUTH]
    signals.samples = {SPEED: [(9.9, 0.0, 0.5)], TRUTH: [(9.9, 0.0, 0.25)]}
    browser.wait_until(lambda: last_values(panel) == [0.5, 0.25])
    browser.choose(SPEED, False)
    browser.wait_until(lambda: signals.open_curves == {TRUTH})
    browser.choose(TRUTH, False)
    browser.wait_until(lambda: signals.open_curves == set() and not plots(browser))


def test_the_box_of_a_curve_stays_while_others_come_and_go(browser, signals):
    add(browser, signals, SPEED)
    box = browser.control(SPEED)
    add(browser, signals, TRUTH)
    browser.choose(TRUTH, False)
    browser.wait_until(lambda: signals.open_curves == {SPEED} and not browser.control(TRUTH))
    assert browser.control(SPEED) == box  # a click on it was not lost
    order = browser.props(SPEED)['order']
    assert all(plot['props']['order'] < order for plot in browser.received('GuiUplotMessage'))


def test_a_curve_is_added_once(browser, signals):
    add(browser, signals, SPEED)
    browser.click('Add curve')
    browser.read(0.2)
    assert len(plots(browser)) == 1
    assert signals.opened == [SPEED]


def test_what_cannot_be_plotted_is_told(browser, signals, complaints):
    signals.fault = 'There is no such thing.'
    browser.choose('Curve', '/nothing')
    browser.click('Add curve')
    browser.wait_until(lambda: complaints == ['There is no such thing.'])
    assert not plots(browser)


def test_a_topic_that_has_gone_is_tried_again(browser, signals, panel):
    add(browser, signals, SPEED)
    panel.close()
    signals.fault = 'It is not there.'
    panel.open()
    assert signals.open_curves == set()
    signals.fault = ''
    panel.refresh()
    assert signals.open_curves == {SPEED}


def test_a_reset_of_time_begins_anew(browser, signals, panel):
    add(browser, signals, SPEED)
    signals.samples = {SPEED: [(9.9, 0.0, 0.5)]}
    browser.wait_until(lambda: last_values(panel) == [0.5])
    panel.move(clock(0.0))
    browser.wait_until(lambda: list(panel._plot.data[0]) == [0.0])  # the times that are shown
    panel.move(clock(10.0))
    browser.wait_until(lambda: panel._plot.data[0][-1] == 10.0)
    assert np.isnan(panel._plot.data[1]).all()  # what was sent before does not come again
    assert panel._time(None, arrival=0.0) == 0.0
    signals.samples = {SPEED: [(10.0, 0.0, 0.75)]}
    browser.wait_until(lambda: last_values(panel) == [0.75])


def test_without_a_stamp_of_this_clock_the_time_of_arrival_counts(panel):
    now = time.monotonic()
    panel._clock.clear()
    panel._clock.extend([(now - 1.0, 10.0), (now, 20.0)])
    assert panel._time(None, now - 0.5) == pytest.approx(15.0)
    assert panel._time(1.6e9, now - 0.5) == pytest.approx(15.0)
    assert panel._time(14.0, now - 0.5) == 14.0
