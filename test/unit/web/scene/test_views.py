"""Views of a browser: by buttons and keys, and by no other browser's."""

import math
from contextlib import ExitStack

import numpy as np
import pytest
from support.browser import CAMERA, Browser
from support.window import clock, model, selection

from rosbots_description.sim.core import Pose
from rosbots_description.sim.description import Plane, SceneChange
from rosbots_description.web.scene import views
from rosbots_description.web.scene.ground import CLEARANCE


@pytest.fixture
def looking(browser, simulator, page):
    """A browser that looks at boxes of 1 m from above."""
    simulator.change(SceneChange(True, (model('a', 1), model('b', 2), model('ground', 3, Plane()))))
    simulator.motion(clock(_1=Pose((0.0, 0.0, 0.0)), _2=Pose((10.0, 0.0, 0.0))))
    browser.wait_until(lambda: '/models/b/link/0 v' in browser.nodes)
    browser.wait_until(lambda: browser.nodes['/models/b/link'][1] == [10.0, 0.0, 0.0])
    browser.wait_until(lambda: page._ground._expected)
    catch_up(browser, page, 'told')
    report(browser, *browser.view())
    browser.wait_until(lambda: not page._ground._expected)
    report(browser, (0.0, 0.0, 50.0), (0.0, 0.0, 0.0))
    browser.wait_until(lambda: browser.control('Home'))
    catch_up(browser, page, 'begin')
    return browser


def report(browser, eye, target):
    browser.send(CAMERA | {'position': [*map(float, eye)], 'look_at': [*map(float, target)]})


def catch_up(browser, page, word):
    """Read all that the page has told a browser until now."""
    page._notify(word)
    browser.wait_until(lambda: word in browser.notes())


def turned(browser, page, act):
    """Return eye and target after an act."""
    browser.messages.clear()
    act()
    browser.wait_until(lambda: browser.received('SetCameraLookAtMessage'))
    catch_up(browser, page, 'turned')
    eye, target = browser.view()
    return np.array(eye), np.array(target)


def test_the_top_view_shows_everything_but_planes(looking, page):
    eye, target = turned(looking, page, lambda: looking.press('T'))
    assert target[:2] == pytest.approx([5.0, 0.0], abs=0.05)
    assert eye - target == pytest.approx([0.0, 0.0, eye[2] - target[2]], abs=0.1)
    radius = 5.5
    assert radius < (eye[2] - target[2]) * math.tan(CAMERA['fov'] / 2.0) < 2.0 * radius


def test_a_view_from_the_front_is_ahead(looking, page):
    eye, target = turned(looking, page, lambda: looking.click('Front'))
    assert eye[0] > 15.0
    assert eye[1] == pytest.approx(target[1])
    assert eye[2] > target[2]


def test_what_is_selected_is_gone_to_from_where_one_is(looking, client, page):
    selection(page).choose('b')
    report(looking, (0.0, -20.0, 2.0), (0.0, 0.0, 2.0))
    looking.wait_until(lambda: tuple(client.camera.position) == (0.0, -20.0, 2.0))
    eye, target = turned(looking, page, lambda: looking.press('G'))
    assert target[:2] == pytest.approx([10.0, 0.0], abs=0.05)
    assert (eye - target)[[0, 2]] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert -4.0 < eye[1] < -1.0


def test_home_is_the_first_view(looking, page):
    first = [np.array(part) for part in page._start.choose()]
    for found, wanted in zip(turned(looking, page, lambda: looking.press('H')), first, strict=True):
        assert found == pytest.approx(wanted)


def test_other_browsers_keep_their_views(looking, page, site):
    with Browser(site.address) as other:
        other.wait_until(lambda: other.control('Home') and len(site.get_clients()) == 2)
        catch_up(other, page, 'there')
        seen = len(other.messages)
        turned(looking, page, lambda: looking.press('T'))
        catch_up(other, page, 'after')
        assert not [m for m in other.messages[seen:] if m['type'].startswith('SetCamera')]


def test_nothing_to_go_to_is_no_fault(looking, page):
    looking.messages.clear()
    looking.press('G')
    turned(looking, page, lambda: looking.press('T'))
    assert len(looking.received('SetCameraPositionMessage')) == 1


def test_a_double_click_goes_to_the_model_and_keeps_it_selected(looking, page, monkeypatch):
    monkeypatch.setattr(views, 'DOUBLE', math.inf)
    looking.click_node('/models/b/link/0 v')
    looking.wait_until(lambda: selection(page).model == 'b')
    _, target = turned(looking, page, lambda: looking.click_node('/models/b/link/0 v'))
    assert target[:2] == pytest.approx([10.0, 0.0], abs=0.05)
    assert (selection(page).model, selection(page).link) == ('b', None)


def test_a_camera_below_the_ground_is_lifted_above_it(looking, page):
    ground = 1.0  # [m] height of the fake's
    eye, target = turned(
        looking, page, lambda: report(looking, (0.0, -20.0, -3.0), (1.0, 0.0, 0.0))
    )
    assert eye == pytest.approx([0.0, -20.0, ground + CLEARANCE])
    assert target == pytest.approx([1.0, 0.0, 0.0])


def test_a_camera_that_looks_straight_up_from_below_looks_down_from_above(looking, page):
    eye, target = turned(looking, page, lambda: report(looking, (0.0, 0.0, -3.0), (0.0, 0.0, 0.0)))
    assert eye[2] > target[2]


def test_without_a_ground_a_camera_may_be_anywhere(looking, client, page, simulator):
    simulator.change(SceneChange(removed=('ground',)))
    looking.messages.clear()
    report(looking, (0.0, -20.0, -3.0), (0.0, 0.0, 0.0))
    looking.wait_until(lambda: client.camera.position[2] == -3.0)
    catch_up(looking, page, 'below')
    assert not looking.received('SetCameraPositionMessage')


def test_a_report_from_before_the_first_view_is_no_reason_to_leave_it(browser, simulator, page):
    simulator.change(SceneChange(True, (model('a', 1), model('ground', 3, Plane()))))
    browser.wait_until(lambda: page._ground._expected)
    catch_up(browser, page, 'told')
    first = browser.view()
    below = turned(browser, page, lambda: report(browser, (1.0, 2.0, -3.0), (0.0, 0.0, 0.0)))
    for found, wanted in zip(below, first, strict=True):
        assert found == pytest.approx(wanted)
    report(browser, *first)
    browser.wait_until(lambda: not page._ground._expected)
    eye, _ = turned(browser, page, lambda: report(browser, (1.0, 2.0, -3.0), (0.0, 0.0, 0.0)))
    assert eye == pytest.approx([1.0, 2.0, 1.0 + CLEARANCE])


def test_a_view_that_was_told_is_not_taken_for_a_report(browser, simulator, page, client):
    simulator.change(SceneChange(True, (model('a', 1), model('ground', 3, Plane()))))
    browser.wait_until(lambda: page._ground._expected)
    catch_up(browser, page, 'told')
    first, _ = page._start.choose()
    browser.messages.clear()
    with page._ground._lock:  # both are looked at late, the second when the first is answered
        for eye in ((-5.0, 0.0, -3.0), (-5.0, 0.0, -2.0)):
            report(browser, eye, (0.0, 0.0, 0.0))
            browser.wait_until(lambda eye=eye: tuple(client.camera.position) == eye)
    browser.wait_until(lambda: browser.received('SetCameraLookAtMessage'))
    catch_up(browser, page, 'told again')
    eye, _ = turned(browser, page, lambda: report(browser, (-5.0, 0.0, -1.0), (0.0, 0.0, 0.0)))
    assert eye == pytest.approx(first)


def test_who_comes_at_the_first_view_may_leave_it(looking, page, site):
    first, target = page._start.choose()
    with ExitStack() as left:
        with page._lock:  # it comes late
            other = left.enter_context(Browser(site.address))
            other.wait_until(lambda: len(site.get_clients()) == 2)
            client = site.get_clients()[max(site.get_clients())]
            report(other, first, target)
            other.wait_until(lambda: client.camera.position == pytest.approx(first))
        other.wait_until(lambda: client.client_id in page.browsers)
        eye, _ = turned(other, page, lambda: report(other, (1.0, 2.0, -3.0), (0.0, 0.0, 0.0)))
        assert eye == pytest.approx([1.0, 2.0, 1.0 + CLEARANCE])


def test_who_comes_below_the_ground_is_told_nothing_but_the_first_view(looking, page, site):
    first, _ = page._start.choose()
    with ExitStack() as left:
        with page._lock:  # it is told late
            other = left.enter_context(Browser(site.address))
            other.wait_until(lambda: len(site.get_clients()) == 2)
            client = site.get_clients()[max(site.get_clients())]
            report(other, (1.0, 2.0, -3.0), (0.0, 0.0, 0.0))
            other.wait_until(lambda: client.camera.position[2] == -3.0)
        other.wait_until(lambda: other.received('SetCameraLookAtMessage'))
        catch_up(other, page, 'told')
        told = [m for m in other.received('SetCameraPositionMessage') if not m['initial']]
        assert [m['position'] for m in told] == [pytest.approx(first)]
