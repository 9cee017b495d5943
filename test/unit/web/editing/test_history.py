"""Undo: the last ten changes, the latest first."""

import threading

import pytest
from support.browser import Browser
from support.window import clock

from rosbots_description.sim.core import SimError
from rosbots_description.web.editing.history import History


@pytest.fixture
def told():
    return []


@pytest.fixture
def history(site, told):
    return History(site.gui, told.append)


def test_the_last_change_is_undone_first_by_button_and_key(site, history, told):
    history.add('move a', lambda: told.append('a'))
    history.add('move b', lambda: told.append('b'))
    with Browser(site.address) as browser:
        browser.click('Undo: move b')
        browser.wait_until(lambda: told == ['b'] and browser.control('Undo: move a'))
        browser.press('Z')
        browser.wait_until(lambda: told == ['b', 'a'] and browser.control('Undo'))
        browser.press('Z')  # there is nothing more
        browser.read()
    assert told == ['b', 'a']


def test_one_change_is_undone_after_the_other(history, told):
    began, may_end = threading.Event(), threading.Event()

    def insert_again():
        began.set()
        assert may_end.wait(60.0)
        told.append('insert')

    history.add('move', lambda: told.append('move'))
    history.add('delete', insert_again)
    presses = [threading.Thread(target=history.undo) for _ in range(2)]
    presses[0].start()
    assert began.wait(60.0)
    presses[1].start()
    presses[1].join(0.2)  # it can only wait
    assert told == []
    may_end.set()
    for press in presses:
        press.join()
    assert told == ['insert', 'move']


def test_ten_changes_are_remembered(history, told):
    for number in range(12):
        history.add('move', lambda number=number: told.append(number))
    for _ in range(12):
        history.undo()
    assert told == list(range(11, 1, -1))


def test_a_refusal_is_shown_and_the_change_before_it_can_be_undone(history, told):
    def refuse():
        raise SimError('it is gone.')

    history.add('move a', lambda: told.append('a'))
    history.add('move b', refuse)
    history.undo()
    history.undo()
    assert told == ['Undo: move b: it is gone.', 'a']


def test_changes_of_another_simulator_are_forgotten(history, told):
    history.move(clock(real_time=50.0))
    history.add('move', lambda: told.append(1))
    history.move(clock(real_time=51.0))
    history.move(clock(real_time=0.1))  # it was restarted
    history.undo()
    assert told == []


def test_undo_waits_for_a_change_that_is_being_made(history, told):
    history.add('insert', lambda: told.append('insert'))
    with history.turn:  # a deletion, whose answer is late
        press = threading.Thread(target=history.undo)
        press.start()
        press.join(0.2)  # it can only wait
        history.add('delete', lambda: told.append('delete'))
    press.join()
    assert told == ['delete']
