"""The page lists the faults of the world, and tells of each new one."""

import logging

from rosbots_description.sim.core import Fault, SimError

OLD, NEW = Fault('old <b>'), Fault('new', logging.ERROR, cure='mend it', step=7)


def test_faults_are_listed_the_worst_first_and_the_new_ones_told(browser, simulator, page):
    simulator.known_faults = [OLD]
    page.poll()
    browser.wait_until(lambda: 'Faults (1)' in browser.tables())
    assert '<li>old &lt;b&gt;</li>' in browser.tables()
    simulator.known_faults = [OLD, NEW]
    page.poll()
    browser.wait_until(lambda: 'Faults (2)' in browser.tables())
    assert '<li><b>new; mend it</b></li><li>old' in browser.tables()
    browser.wait_until(browser.notes)
    assert browser.notes() == ['new; mend it']  # the old one was there before anybody looked


def test_without_faults_there_is_no_list(browser, simulator, page):
    simulator.known_faults = [NEW]
    page.poll()
    browser.wait_until(lambda: 'Faults (1)' in browser.tables())
    simulator.known_faults = []
    page.poll()
    browser.wait_until(lambda: browser.tables() == '')


def test_without_an_answer_the_last_list_stays(browser, simulator, page):
    simulator.known_faults = [OLD]
    page.poll()
    simulator.known_faults = _gone()
    page.poll()
    simulator.known_faults = [OLD, NEW]
    page.poll()
    browser.wait_until(browser.notes)
    assert browser.notes() == ['new; mend it'], 'the old one would be new to an empty list'


def _gone():
    raise SimError('it does not answer')
    yield
