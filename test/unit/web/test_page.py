"""The page as a browser gets it: the scene, the clock, and what its controls do."""

import weakref
from types import SimpleNamespace

import pytest
from support.browser import Browser
from support.patience import PATIENCE, wait_until
from support.window import clock, model

from rosbots_description.sim.core import Pose
from rosbots_description.sim.description import LightSpec, Mesh, Plane, SceneChange, SceneSpec
from rosbots_description.web import browser_panels
from rosbots_description.web import page as page_module
from rosbots_description.web.scene.scene import SceneView

SUN = LightSpec('sun', 'directional', direction=(0.0, 0.0, -1.0), cast_shadows=True)


def shown(browser):
    """Return the names of the models that are shown."""
    return {name.split('/')[2] for name in browser.nodes if name.startswith('/models/')}


def test_the_simulator_is_looked_at_only_while_a_browser_is(site, simulator, page):
    assert simulator.change is None
    with Browser(site.address) as first:
        first.wait_until(lambda: simulator.change)
        with Browser(site.address) as second:
            second.wait_until(lambda: len(site.get_clients()) == 2)
        first.wait_until(lambda: len(site.get_clients()) == 1)
        assert simulator.change is not None
    wait_until(lambda: simulator.change is None)


def test_what_was_kept_for_browsers_is_freed_when_all_have_gone(site, page, no_collection):
    with Browser(site.address) as first, Browser(site.address) as second:
        first.wait_until(lambda: second.read() or len(site.get_clients()) == 2)
        kept = [weakref.ref(client) for client in site.get_clients().values()]
    wait_until(lambda: page.poll() or not any(client() for client in kept))


@pytest.mark.parametrize('is_complete', [True, False])
def test_a_browser_that_leaves_while_its_panels_are_made_is_freed(
    site, page, monkeypatch, is_complete
):
    made, kept = browser_panels.InsertPanel, []

    def late(client, *others):
        kept.append(weakref.ref(client))
        nested = client.gui._handles_in_foreign_containers
        wait_until(lambda: not nested)  # viser has removed what was made so far
        panel = made(client, *others)
        if not is_complete:
            nested.clear()  # viser does so first, and a folder enters its tab twice
            raise RuntimeError('viser has removed a control of this panel')
        return panel

    monkeypatch.setattr(browser_panels, 'InsertPanel', late)
    with Browser(site.address) as browser:
        browser.wait_until(lambda: kept)
    wait_until(lambda: page.poll() or not kept[0]())


def test_browsers_that_come_at_once_share_one_view(site, simulator, page, monkeypatch):
    opened = []
    monkeypatch.setattr(simulator, 'open', lambda *_: opened.append(len(site.get_clients())))
    page._lock.acquire()
    with Browser(site.address), Browser(site.address):
        wait_until(lambda: len(site.get_clients()) == 2)
        page._lock.release()
        wait_until(lambda: opened)
    assert opened == [2]


def test_models_come_move_and_go(browser, simulator):
    simulator.change(SceneChange(True, (model('a/b', 1), model('c', 2)), lights={'sun': SUN}))
    browser.wait_until(lambda: shown(browser) == {'a\u2215b', 'c'})
    assert browser.nodes['/models/c/link/0 v'][0] == 'GlbMessage'
    assert browser.nodes['/models/c/link/0 v'][1:] == [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0]]
    pose = Pose((1.0, 2.0, 3.0), (0.0, 0.0, 1.0, 0.0))
    simulator.motion(clock(_2=pose, _9=pose))
    link = browser.nodes['/models/c/link']
    browser.wait_until(lambda: link[1:] == [[1.0, 2.0, 3.0], [0.0, 0.0, 0.0, 1.0]])
    simulator.change(SceneChange(models=(model('d', 3),), removed=('c',), lights={'sun': SUN}))
    browser.wait_until(lambda: shown(browser) == {'a\u2215b', 'd'})


def test_a_second_browser_sees_the_same(browser, simulator, site):
    simulator.change(SceneChange(True, (model('a', 1),)))
    simulator.motion(clock(_1=Pose((5.0, 0.0, 0.0))))
    with Browser(site.address) as second:
        second.wait_until(lambda: second.nodes.get('/models/a/link', [0, 0])[1] == [5.0, 0.0, 0.0])


def test_a_simulator_that_restarted_shows_its_own_models(browser, simulator):
    simulator.change(SceneChange(True, (model('a', 1), model('b', 2))))
    browser.wait_until(lambda: shown(browser) == {'a', 'b'})
    before = len(browser.received('GlbMessage'))
    simulator.change(SceneChange(True, (model('b', 0, position=(0.0, 7.0, 0.0)),)))
    simulator.motion(clock(_0=Pose((0.0, 8.0, 0.0))))
    browser.wait_until(lambda: shown(browser) == {'b'})
    browser.wait_until(lambda: browser.nodes['/models/b/link'][1] == [0.0, 8.0, 0.0])
    # What looks the same is not sent again.
    assert len(browser.received('GlbMessage')) == before


def test_poses_of_a_simulator_that_restarts_are_not_those_of_the_next(browser, simulator, page):
    simulator.change(SceneChange(True, (model('a', 1),)))
    with page._lock:  # so that nothing is shown meanwhile
        simulator.motion(clock(_1=Pose((5.0, 0.0, 0.0))))
        simulator.change(SceneChange(True, (model('b', 1), model('c', 2))))
    simulator.motion(clock(_2=Pose((6.0, 0.0, 0.0))))
    browser.wait_until(lambda: browser.nodes.get('/models/c/link', [0, 0])[1] == [6.0, 0.0, 0.0])
    assert browser.nodes['/models/b/link'][1] == [0.0, 0.0, 0.0]


def test_a_mesh_that_cannot_be_read_is_left_out(browser, simulator, caplog):
    simulator.change(SceneChange(True, (model('a', 1, Mesh('/gone.stl')), model('b', 2))))
    browser.wait_until(lambda: '/models/b/link/0 v' in browser.nodes)
    assert '/models/a/link/0 v' not in browser.nodes
    assert "visual 'v' of model 'a' is not shown" in caplog.text


def test_only_a_ground_has_a_grid(site):
    view = SceneView(site, lambda *_: None)
    view.apply(
        SceneChange(
            True,
            (
                model('ground', 1, Plane()),
                model('wall', 2, Plane((1.0, 0.0, 0.0))),
                model('box', 3, position=(100.0, 0.0, 0.0)),
            ),
        )
    )
    assert site.scene.get_handle_by_name('/models/ground/link/0 v/grid') is not None
    assert site.scene.get_handle_by_name('/models/wall/link/0 v/grid') is None


def test_everything_is_in_view_and_the_start_looks_there(browser, simulator):
    simulator.change(
        SceneChange(True, tuple(model(str(x), x, position=(float(x), 0.0, 0.0)) for x in (1, 9)))
    )
    browser.wait_until(lambda: browser.view()[1] == [5.0, 0.0, 1.0])


def test_a_view_is_chosen_for_those_who_come_only(browser, simulator, site, page, monkeypatch):
    simulator.change(SceneChange(True, (model('a', 1),)))
    chosen = []
    eye, target = (3.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    monkeypatch.setattr(
        page._start, 'choose', lambda aspect=None: chosen.append(aspect) or (eye, target)
    )
    simulator.change(SceneChange(models=(model('b', 2),)))
    assert chosen == []
    with Browser(site.address) as second:
        second.wait_until(lambda: chosen == [None, 1.0])


def test_lights_are_those_of_the_world(browser, simulator):
    lamp = LightSpec('lamp', 'point', Pose((1.0, 2.0, 3.0)), (1.0, 0.5, 0.0, 1.0))
    spot = LightSpec('spot', 'spot', spot_outer_angle=1.0, spot_inner_angle=0.5)
    simulator.change(SceneChange(True, lights={'sun': SUN, 'lamp': lamp, 'spot': spot}))
    browser.wait_until(lambda: '/lights/spot' in browser.nodes)
    # It shines towards the origin.
    assert browser.nodes['/lights/sun'][:2] == ['DirectionalLightMessage', [0.0, 0.0, 100.0]]
    assert browser.nodes['/lights/lamp'][:2] == ['PointLightMessage', [1.0, 2.0, 3.0]]
    (message,) = browser.received('PointLightMessage')
    assert message['props']['color'] == [255, 128, 0]
    simulator.change(SceneChange(lights={'sun': SUN}))
    browser.wait_until(lambda: '/lights/lamp' not in browser.nodes)


def test_a_world_without_shadows_has_none(browser, simulator):
    simulator.change(SceneChange(True, lights={'sun': SUN}, scene=SceneSpec(shadows=False)))
    browser.wait_until(lambda: '/lights/sun' in browser.nodes)
    (message,) = browser.received('DirectionalLightMessage')
    assert not message['props']['cast_shadow']


def test_the_clock_shows_times_and_the_real_time_factor(browser, simulator):
    simulator.motion(clock(10.0, 20.0))
    browser.wait_until(lambda: browser.shows('00:00:10.000'))
    simulator.motion(clock(10.5, 21.0))
    browser.wait_until(lambda: browser.shows('00:00:10.500') and browser.shows('0.50\u00d7'))
    tooltip = 'real time 00:00:21.000, 10500 iterations'
    assert any(tooltip in content for content in browser.contents())
    simulator.motion(clock(0.0, 22.0))  # reset
    simulator.motion(clock(2.0, 23.0, paused=True))
    browser.wait_until(lambda: browser.shows('paused'))
    assert browser.control('Play')


def test_buttons_tell_the_simulator(browser, simulator):
    browser.wait_until(lambda: browser.control('Step'))
    browser.choose('Steps', 5)
    for told, label in enumerate(('Step', 'Pause', 'Reset world', 'Reset time and world'), 1):
        browser.click(label)
        browser.wait_until(lambda told=told: len(simulator.told) == told)
    browser.choose('Speed', 'as fast as possible')
    browser.wait_until(lambda: len(simulator.told) == 5)
    assert simulator.told == [
        ('step', 5),
        ('pause',),
        ('reset_world',),
        ('reset_simulation',),
        ('set_speed', 0.0),
    ]
    simulator.motion(clock(paused=True))
    browser.click('Play')
    browser.wait_until(lambda: simulator.told[-1] == ('unpause',))


def test_the_speed_of_the_simulator_is_shown_and_not_told_to_it(browser, simulator):
    simulator.change(SceneChange(True, max_update_rate=100.0))
    browser.wait_until(lambda: browser.value('Speed') == '0.1x')
    assert simulator.told == []


def test_a_speed_that_was_chosen_stays_until_the_simulator_has_another(browser, simulator):
    simulator.change(SceneChange(True))
    browser.choose('Speed', '10x')
    browser.wait_until(lambda: simulator.told)
    simulator.change(SceneChange())  # on its way since before
    simulator.change(SceneChange(max_update_rate=100.0))
    browser.wait_until(lambda: browser.value('Speed') == '0.1x')
    shown = [
        message['updates'].get('value')
        for message in browser.received('GuiUpdateMessage')
        if message['uuid'] == browser.control('Speed')
    ]
    assert shown == ['0.1x']


def test_a_browser_that_has_gone_before_it_is_let_in_opens_nothing(simulator, page):
    page._enter(SimpleNamespace(client_id=99))
    assert simulator.change is None


def test_a_refusal_is_shown(browser, simulator):
    browser.wait_until(lambda: browser.control('Pause'))
    simulator.fault = 'no: because.'
    browser.click('Pause')
    browser.wait_until(lambda: browser.notes() == ['no: because.'])


def test_a_simulator_that_has_gone_and_returns_is_told_of(browser, simulator, page, monkeypatch):
    monkeypatch.setattr(page_module, 'SILENCE', PATIENCE)
    simulator.motion(clock())
    page.poll()
    browser.read()
    assert not browser.shows(page_module.GONE)
    monkeypatch.setattr(page_module, 'SILENCE', 0.0)
    page.poll()
    browser.wait_until(lambda: browser.shows(page_module.GONE))
    simulator.motion(clock())
    browser.wait_until(lambda: page_module.BACK in browser.notes())
    browser.wait_until(lambda: not browser.shows(page_module.GONE))
