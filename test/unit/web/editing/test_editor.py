"""What is done to the selected model: it is moved, pushed, duplicated and deleted."""

import threading

import pytest
from support.browser import Browser
from support.window import clock, model, selection

from rosbots_description.sim.core import Pose
from rosbots_description.sim.description import ModelText, SceneChange
from rosbots_description.web.editing import gizmo
from rosbots_description.web.editing.gizmo import NODE

TEXT = ModelText('a', 'text', pose=Pose((1.0, 0.0, 0.0)))


@pytest.fixture
def chosen(browser, simulator, page):
    """A browser with the model 'a' at (1, 0, 0) selected."""
    simulator.change(SceneChange(True, (model('a', 1, position=(1.0, 0.0, 0.0)), model('b', 2))))
    selection(page).choose('a')
    browser.wait_until(lambda: NODE in browser.nodes)
    return browser


def moves(simulator):
    """Return the positions to which models were moved, or at which they were held."""
    return [pose.position for _, _, pose, *_ in simulator.done('move', 'hold')]


def grab(browser, simulator):
    """Grab the model; return when it is held."""
    browser.grab(NODE)
    browser.wait_until(lambda: moves(simulator))


def is_free(browser, simulator):
    """Return whether no model is held any more."""
    told = len(simulator.told)
    browser.read(3 * gizmo.PERIOD)
    return len(simulator.told) == told


def test_delete_and_undo_spawn_it_as_it_was(chosen, simulator):
    chosen.click('Delete')
    chosen.click("Undo: delete 'a'")
    chosen.wait_until(lambda: len(simulator.told) == 3)
    assert simulator.told == [('describe', 'a'), ('delete', 'a'), ('insert', TEXT, False, False)]


def test_duplicate_is_beside_it_and_selected(chosen, simulator, page):
    chosen.press('D')
    chosen.wait_until(lambda: chosen.control("Undo: duplicate 'a'"))
    assert simulator.told == [('describe', 'a'), ('insert', TEXT, False, True)]
    simulator.change(SceneChange(models=(model('new a', 9),)))
    assert selection(page).model == 'new a'
    chosen.click("Undo: duplicate 'a'")
    chosen.wait_until(lambda: simulator.told[-1] == ('delete', 'new a'))


def test_push_acts_on_the_selected_link_else_on_the_canonical_one(chosen, simulator, page):
    chosen.choose('Torque [N m]', [0.0, 0.0, 5.0])
    chosen.choose('Duration [s]', 0.5)
    chosen.click('Push')
    chosen.wait_until(lambda: len(simulator.told) == 1)
    selection(page).choose('b', 'link')
    chosen.choose('Axes of the', 'link')
    chosen.click('Push')
    chosen.wait_until(lambda: len(simulator.told) == 2)
    force, torque = (0.0, 0.0, 100.0), (0.0, 0.0, 5.0)
    assert simulator.told == [
        ('push', 'a::link', force, torque, 0.5, False),
        ('push', 'b::link', force, torque, 0.5, True),
    ]


def test_refusal_is_shown_and_nothing_can_be_undone(chosen, simulator):
    simulator.fault = 'no: because.'
    chosen.click('Delete')
    chosen.wait_until(lambda: 'no: because.' in chosen.notes())
    assert chosen.control('Undo')


def test_without_a_selection_nothing_is_done(chosen, simulator, page):
    selection(page).choose(None)
    chosen.wait_until(lambda: NODE not in chosen.nodes)
    chosen.click('Delete')
    chosen.press('delete')
    chosen.read(0.2)
    assert simulator.told == []


def test_gizmo_is_at_the_selected_model_and_follows_it(chosen, simulator, page):
    assert chosen.nodes[NODE][1] == [1.0, 0.0, 0.0]
    simulator.motion(clock(_1=Pose((2.0, 3.0, 4.0))))
    chosen.wait_until(lambda: chosen.nodes[NODE][1] == [2.0, 3.0, 4.0])
    selection(page).choose('b')
    chosen.wait_until(lambda: chosen.nodes[NODE][1] == [0.0, 0.0, 0.0])


def test_choosing_a_link_of_the_model_does_not_end_a_drag(chosen, simulator, page):
    grab(chosen, simulator)
    selection(page).choose('a', 'link')
    chosen.drag(NODE, [1.0, 2.0, 3.0])
    chosen.wait_until(lambda: moves(simulator)[-1] == (1.0, 2.0, 3.0))
    chosen.let_go(NODE)
    chosen.wait_until(lambda: chosen.control("Undo: move 'a'"))


def test_dragged_model_is_held_until_it_is_let_go(chosen, simulator):
    chosen.grab(NODE)
    chosen.wait_until(lambda: len(moves(simulator)) > 2)  # it is held before it moves
    chosen.drag(NODE, [1.0, 2.0, 3.0])
    chosen.wait_until(lambda: moves(simulator)[-1] == (1.0, 2.0, 3.0))
    simulator.motion(clock(_1=Pose((7.0, 7.0, 7.0))))
    chosen.read(0.1)
    assert chosen.nodes[NODE][1] == [1.0, 0.0, 0.0]  # viser tells the browsers that do not drag
    chosen.drag(NODE, [4.0, 5.0, 6.0])
    chosen.let_go(NODE)
    chosen.wait_until(lambda: chosen.control("Undo: move 'a'"))
    assert moves(simulator)[-1] == (4.0, 5.0, 6.0)
    assert is_free(chosen, simulator)
    assert {what[3] for what in simulator.told[:-1]} == {gizmo.HOLD}
    assert simulator.told[-1][3] == 0.0
    chosen.click("Undo: move 'a'")
    chosen.wait_until(lambda: moves(simulator)[-1] == (1.0, 0.0, 0.0))


def test_undo_waits_until_a_dragged_model_is_let_go(chosen, simulator, monkeypatch):
    placed, answer = threading.Event(), threading.Event()

    def hold(*arguments):
        if arguments[-1] == 0.0:
            placed.set()
            answer.wait(60.0)
        simulator.told.append(('hold', *arguments))

    monkeypatch.setattr(simulator, 'hold', hold, raising=False)
    chosen.grab(NODE)
    chosen.drag(NODE, [1.0, 2.0, 3.0])
    chosen.let_go(NODE)
    chosen.wait_until(placed.is_set)
    chosen.press('Z')
    chosen.read(0.2)  # it can only wait
    answer.set()
    chosen.wait_until(lambda: simulator.told[-1] == ('move', 'a', Pose((1.0, 0.0, 0.0))))


def test_what_was_only_grabbed_has_not_moved(chosen, simulator):
    chosen.grab(NODE)
    chosen.let_go(NODE)
    chosen.wait_until(lambda: moves(simulator))
    chosen.read(0.2)
    assert chosen.control('Undo')


def test_slow_simulator_gets_the_newest_pose_only(chosen, simulator, site, monkeypatch):
    answer, calls = threading.Event(), []

    def hold(_name, pose, _duration):
        calls.append(pose.position)
        answer.wait(60.0)

    monkeypatch.setattr(simulator, 'hold', hold, raising=False)
    chosen.grab(NODE)
    chosen.wait_until(lambda: calls)
    for x in range(100):
        chosen.drag(NODE, [float(x), 0.0, 0.0])
    chosen.let_go(NODE)
    chosen.choose('Steps', 7)  # the page is not blocked
    with Browser(site.address) as other:  # and has taken in all that
        other.wait_until(lambda: other.control('Steps') and other.value('Steps') == 7)
    assert len(calls) == 1
    answer.set()
    chosen.wait_until(lambda: chosen.control("Undo: move 'a'"))
    assert calls == [(1.0, 0.0, 0.0), (99.0, 0.0, 0.0)]


def select_too(other):
    """Select the model in another browser."""
    other.click_node('/models/a/link/0 v')
    other.wait_until(lambda: NODE in other.nodes)


def test_browser_that_ends_while_it_drags_releases_the_model(chosen, simulator, site):
    with Browser(site.address) as other:
        select_too(other)
        other.grab(NODE)
        other.drag(NODE, [5.0, 0.0, 0.0])
        chosen.wait_until(lambda: moves(simulator)[-1:] == [(5.0, 0.0, 0.0)])
    chosen.wait_until(lambda: chosen.control("Undo: move 'a'"))
    assert is_free(chosen, simulator)


def test_of_two_browsers_the_one_that_grabbed_last_moves_it(chosen, simulator, site):
    with Browser(site.address) as other:
        select_too(other)
        chosen.grab(NODE)
        chosen.wait_until(lambda: moves(simulator))
        other.grab(NODE)
        other.drag(NODE, [5.0, 0.0, 0.0])
        chosen.wait_until(lambda: moves(simulator)[-1] == (5.0, 0.0, 0.0))
        chosen.drag(NODE, [8.0, 0.0, 0.0])
        chosen.let_go(NODE)
        chosen.read(0.2)
        other.let_go(NODE)
        chosen.wait_until(lambda: chosen.control("Undo: move 'a'"))
    assert (8.0, 0.0, 0.0) not in moves(simulator)


def test_model_that_is_deleted_while_it_is_dragged_is_not_let_go(chosen, simulator):
    grab(chosen, simulator)
    chosen.press('delete')
    chosen.wait_until(lambda: chosen.control("Undo: delete 'a'"))
    chosen.wait_until(lambda: is_free(chosen, simulator))
    assert all(duration for *_, duration in simulator.done('hold'))


def test_model_that_goes_ends_the_drag_in_a_sentence(chosen, simulator):
    grab(chosen, simulator)
    simulator.fault = 'HoldModel: model does not exist'
    chosen.wait_until(lambda: simulator.fault in chosen.notes())
    assert chosen.notes().count(simulator.fault) == 1
    simulator.change(SceneChange(removed=('a',)))
    chosen.wait_until(lambda: NODE not in chosen.nodes)


def test_another_selection_releases_the_model(chosen, simulator, page):
    grab(chosen, simulator)
    selection(page).choose('b')
    chosen.wait_until(lambda: simulator.told[-1][3] == 0.0)
    assert is_free(chosen, simulator)
