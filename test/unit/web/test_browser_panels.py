"""Two browsers of one world: each has its own selection, and the panels that act on it."""

import gc
import threading
import weakref

import pytest
from support.browser import Browser
from support.patience import PATIENCE, wait_until
from support.window import clock, model, selection

from rosbots_description.sim.core import Pose, SimError
from rosbots_description.sim.description import (
    REVOLUTE,
    JointSpec,
    SceneChange,
    ShownLink,
    ShownModel,
)
from rosbots_description.web import page as page_module
from rosbots_description.web.editing.gizmo import NODE


@pytest.fixture
def other(browser, simulator, page, site):
    """A second browser at a page with two models; the first one has selected 'a', this one 'b'."""
    simulator.change(SceneChange(True, (model('a', 1), model('b', 2, position=(5.0, 0.0, 0.0)))))
    with Browser(site.address) as other:
        for one, name in ((browser, 'a'), (other, 'b')):
            one.click_node(f'/models/{name}/link/0 v')
            one.wait_until(lambda one=one: NODE in one.nodes)
        yield other


def selected(browser):
    """Return the names of the models with a box around them."""
    return {name.split('/')[2] for name in browser.nodes if name.endswith('/selected')}


def test_each_sees_box_handle_and_numbers_of_its_own_selection(browser, other, simulator, page):
    for one, name, x in ((browser, 'a', 0.0), (other, 'b', 5.0)):
        one.wait_until(lambda one=one, name=name: f'<b>{name}</b>' in one.tables())
        assert selected(one) == {name}
        assert one.nodes[NODE][1] == [x, 0.0, 0.0]
    page.poll()
    assert {model for _, model, _ in simulator.done('state')} == {'a', 'b'}
    simulator.motion(clock(0.1, 0.1, _2=Pose((6.0, 0.0, 0.0))))
    other.wait_until(lambda: other.nodes[NODE][1] == [6.0, 0.0, 0.0])
    browser.read(0.1)
    assert browser.nodes[NODE][1] == [0.0, 0.0, 0.0]


def test_a_click_before_the_panels_are_made_is_not_lost(browser, simulator, site, monkeypatch):
    simulator.change(SceneChange(True, (model('a', 1),)))
    simulator.save = lambda: saved.set() or ('<sdf/>', 'saved')
    saved, made = threading.Event(), threading.Event()
    panels = page_module.BrowserPanels
    monkeypatch.setattr(
        page_module, 'BrowserPanels', lambda *arguments: made.wait(PATIENCE) and panels(*arguments)
    )
    with Browser(site.address) as other:
        other.click_node('/models/a/link/0 v')
        other.click('World')
        assert saved.wait(PATIENCE)  # clicks are taken in their order
        made.set()
        other.wait_until(lambda: selected(other) == {'a'})


def test_delete_and_escape_act_on_the_own_selection(browser, other, simulator):
    browser.press('escape')
    browser.wait_until(lambda: NODE not in browser.nodes)
    browser.press('delete')
    other.press('delete')
    other.wait_until(lambda: simulator.done('delete'))
    assert simulator.done('delete') == [('delete', 'b')]
    simulator.change(SceneChange(removed=('b',)))
    other.wait_until(lambda: NODE not in other.nodes)


def test_a_copy_is_selected_where_it_was_made(browser, other, simulator, page):
    other.press('D')
    other.wait_until(lambda: other.control("Undo: duplicate 'b'"))
    simulator.change(SceneChange(models=(model('new b', 3),)))
    other.wait_until(lambda: selected(other) == {'new b'})
    browser.read(0.1)
    assert selected(browser) == {'a'}
    browser.click("Undo: duplicate 'b'")  # what was done to the world, all can undo
    browser.wait_until(lambda: simulator.done('delete') == [('delete', 'new b')])


def test_what_is_typed_and_chosen_stays_where_it_was(browser, other, simulator, page):
    arm = ShownModel(
        'arm', (ShownLink(7, 'link', Pose()),), (JointSpec('elbow', REVOLUTE, 'a', 'b'),)
    )
    simulator.change(SceneChange(models=(arm,)))
    page.poll()
    browser.wait_until(lambda: 'arm' in browser.props('Of')['options'])
    chosen = {'Find': 'x', 'Shape mass [kg]': 7.0, 'Frames': True, 'Of': 'arm', 'Speed [m/s]': 2.0}
    for label, value in chosen.items():
        browser.choose(label, value)
    browser.wait_until(
        lambda: browser.control('elbow [rad]') and '/models/a/link/Frames' in browser.nodes
    )
    browser.choose('Steps', 5)  # how time goes is for all
    other.wait_until(lambda: other.value('Steps') == 5)
    assert [other.value(label) for label in chosen] == ['', 1.0, False, '', 0.5]
    assert other.control('elbow [rad]') is None
    assert '/models/a/link/Frames' not in other.nodes


def test_each_drives_its_own_robot(browser, other, simulator, page):
    simulator.topics = ('/a/cmd_vel', '/b/cmd_vel')
    page.poll()

    def topics():
        return [
            number
            for number, (_, props) in other.controls.items()
            if '/b/cmd_vel' in props.get('options', ())
        ]

    other.wait_until(topics)
    (number,) = topics()
    other.update(number, '/b/cmd_vel')
    for one in (other, browser):
        one.press('I')
        one.read(0.05)
    browser.wait_until(
        lambda: {topic for _, topic, *_ in simulator.done('drive')} == {'/a/cmd_vel', '/b/cmd_vel'}
    )


def test_a_refusal_is_shown_to_who_is_refused(browser, other, simulator):
    simulator.fault = 'no: because.'
    other.press('delete')
    other.wait_until(lambda: other.notes() == ['no: because.'])
    browser.read(0.1)
    assert browser.notes() == []


def test_the_state_of_a_model_is_asked_for_once_for_all(browser, other, simulator, page):
    other.click_node('/models/a/link/0 v')
    other.wait_until(lambda: selected(other) == {'a'})
    for count in (1, 2):
        simulator.told.clear()
        page.poll()
        assert simulator.told.count(('state', 'a', None)) == 1, count


def test_a_simulator_that_does_not_answer_is_waited_for_once(
    browser, other, simulator, page, monkeypatch
):
    asked = []

    def state(*arguments):
        asked.append(arguments)
        raise SimError('it does not answer')

    monkeypatch.setattr(simulator, 'state', state)
    page.poll()
    assert len(asked) == 1


def test_when_one_has_gone_the_other_goes_on_and_nothing_is_kept(
    browser, other, simulator, page, site, capfd
):
    first = weakref.ref(next(iter(page.browsers.values())))
    before = len(site._gate._for_viewers)
    browser.close()
    wait_until(lambda: len(page.browsers) == 1)
    wait_until(lambda: gc.collect() >= 0 and first() is None)
    assert len(site._gate._for_viewers) < before
    assert selection(page).model == 'b'
    page.poll()
    other.click('a')
    other.wait_until(lambda: selected(other) == {'a'})
    other.press('delete')
    other.wait_until(lambda: simulator.done('delete'))
    assert simulator.done('delete') == [('delete', 'a')]
    assert 'Traceback' not in capfd.readouterr().err


def test_a_command_that_ends_after_its_browser_has_left_fails_nothing(
    browser, other, simulator, page, monkeypatch, capfd
):
    begun, answer = threading.Event(), threading.Event()

    def insert(text, on_ground=False, beside=False):
        begun.set()
        answer.wait()
        return 'a'  # which is selected at once, with links that get new buttons

    monkeypatch.setattr(simulator, 'insert', insert)
    other.click('Insert shape')
    wait_until(begun.is_set)
    other.close()
    wait_until(lambda: len(page.browsers) == 1)
    answer.set()
    browser.wait_until(lambda: browser.control("Undo: insert 'a'"))
    assert 'Traceback' not in capfd.readouterr().err


def test_a_browser_that_leaves_while_it_is_let_in_leaves_nothing(client, site, page, monkeypatch):
    """Viser takes the controls of a browser away before it calls back."""
    from rosbots_description.web import browser_panels

    def leave(client, *_):
        site._connected_clients.pop(client.client_id)
        raise RuntimeError

    monkeypatch.setattr(browser_panels, 'ViewPanel', leave)
    page._leave(client)
    page._enter(client)
    assert page.browsers == {}
