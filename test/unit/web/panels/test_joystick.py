"""The joystick: a knob that is dragged steers, and returns when it is let go."""

import math
import time
from types import SimpleNamespace

import pytest
import viser
from support.browser import CAMERA, Browser
from support.patience import wait_until

from rosbots_description.web.panels.joystick import DEPTH, NODE, RADIUS, Joystick, _corner, corner

KNOB, PAD = f'{NODE}/knob', f'{NODE}/pad'


@pytest.fixture
def commands():
    return []


@pytest.fixture
def joysticks(site, commands):
    """Those of the browsers that have connected, by their numbers."""
    made = {}

    @site.on_client_connect
    def _(client):
        made[client.client_id] = Joystick(client, lambda *command: commands.append(command))

    return made


@pytest.fixture
def joystick(browser, joysticks):
    return next(iter(joysticks.values()))


@pytest.fixture
def browser(site, joysticks):
    with Browser(site.address) as browser:
        browser.choose('Joystick', True)
        browser.wait_until(lambda: KNOB in browser.nodes)
        yield browser


def drag(browser, joystick, phase, right=0.0, down=0.0, node=KNOB):
    """Drag the knob, or another node, to a place on the pad, in parts of its radius."""
    at = [0.0, 0.0, 0.0]
    if (pad := joystick._pad) is not None:
        # The camera of the browser looks ahead along z, x is right and y is down.
        at = [float(part) for part in pad.frame.position]
        at[0] += right * pad.radius
        at[1] += down * pad.radius
    owner = next(m['owner'] for m in browser.messages if m.get('name') == node and 'owner' in m)
    browser.drag_node(node, phase, at, owner)


def test_the_pad_is_in_the_lower_left_corner(joystick, client):
    x, y, z = corner(client.camera).position
    camera = client.camera.position
    assert x < camera[0]
    assert y > camera[1]
    assert z > camera[2]


def test_it_stays_there_while_the_camera_moves_and_only_while_it_is_there(
    browser, joystick, client, capfd
):
    def moves():
        moved = browser.received('SetPositionMessage')
        return [m['position'] for m in moved if m['name'] == NODE]

    browser.look_at([1.0, 0.0, 0.0], position=[5.0, 0.0, 0.0])
    browser.wait_until(
        lambda: moves()[-1:] == [pytest.approx(corner(client.camera).position, abs=1e-3)]
    )
    browser.choose('Joystick', False)
    browser.wait_until(lambda: KNOB not in browser.nodes)
    told = len(moves())
    browser.look_at([1.0, 0.0, 0.0], position=[6.0, 0.0, 0.0])
    wait_until(lambda: client.camera.position[0] == 6.0)
    browser.read(0.2)
    assert len(moves()) == told
    assert 'Traceback' not in capfd.readouterr().err  # viser prints what its callbacks raise


def test_its_discs_are_thin_and_face_the_camera(browser, joystick):
    """So they are round also in a corner of the picture."""
    turned = [0.5, 0.5, 0.5, 0.5]
    browser.send({**CAMERA, 'wxyz': turned})
    browser.wait_until(lambda: browser.nodes[NODE][2] == turned)
    discs = [m['props'] for m in browser.received('CylinderMessage')]
    assert len(discs) == 2
    assert all(disc['height'] < 0.2 * disc['radius'] for disc in discs)
    assert all(browser.nodes[disc][2] == [1.0, 0.0, 0.0, 0.0] for disc in (KNOB, PAD))


@pytest.mark.parametrize('node', [KNOB, PAD])
def test_it_steers_while_it_is_held_and_then_stops(browser, joystick, commands, node):
    drag(browser, joystick, 'start', node=node)
    drag(browser, joystick, 'update', right=-0.5, down=-0.5, node=node)
    browser.wait_until(lambda: commands.count(pytest.approx((0.5, 0.5), abs=1e-3)) > 2)
    drag(browser, joystick, 'end', node=node)
    browser.wait_until(lambda: commands[-1] == (0.0, 0.0))
    told = len(commands)
    browser.read(0.4)
    assert len(commands) == told
    assert tuple(joystick._pad.knob.position) == (0.0, 0.0, 0.0)


def test_it_can_be_dragged_as_soon_as_it_is_there(site, joysticks, monkeypatch):
    """Else a press would turn the camera: a browser shows all of a window of messages at once."""
    add = viser.SceneApi.add_cylinder

    def add_slowly(*arguments, **options):
        node = add(*arguments, **options)
        time.sleep(0.2)  # windows are sent every 1/60 s
        return node

    monkeypatch.setattr(viser.SceneApi, 'add_cylinder', add_slowly)
    windows = {}
    with Browser(site.address) as browser:
        take = browser._take

        def note(message):
            if message.get('name') in (KNOB, PAD):
                windows.setdefault(message['type'], set()).add(browser.windows)
            take(message)

        browser._take = note
        browser.choose('Joystick', True)
        browser.wait_until(lambda: 'SetSceneNodeDragBindingsMessage' in windows)
    assert windows['SetSceneNodeDragBindingsMessage'] == windows['CylinderMessage']
    assert len(windows['CylinderMessage']) == 1


def test_an_upright_picture_has_it_above_the_sheet_of_a_phone():
    def height(aspect):
        camera = SimpleNamespace(fov=1.0, aspect=aspect)
        down = _corner(camera)[1] / (2.0 * DEPTH * math.tan(0.5))  # from the middle
        return 0.5 - down

    assert height(0.46) - RADIUS > 0.08 > 56.0 / 844.0  # of the sheet's handle on such a phone
    assert height(2.0) == pytest.approx(0.16)


def test_beyond_the_pad_it_is_at_its_edge(browser, joystick, commands):
    drag(browser, joystick, 'start')
    drag(browser, joystick, 'update', right=3.0, down=-3.0)
    edge = math.sqrt(0.5)
    browser.wait_until(lambda: pytest.approx((edge, -edge), abs=1e-3) in commands)


def test_a_browser_that_goes_while_it_steers_lets_go(browser, joystick, commands, site):
    drag(browser, joystick, 'start')
    drag(browser, joystick, 'update', down=-1.0)
    browser.wait_until(lambda: commands)
    browser._connection.close()
    wait_until(lambda: commands[-1] == (0.0, 0.0))


def test_a_pad_that_is_removed_while_it_is_dragged_lets_go(
    browser, joystick, commands, site, capfd
):
    drag(browser, joystick, 'start')
    drag(browser, joystick, 'update', down=-1.0)
    browser.wait_until(lambda: commands)
    browser.choose('Joystick', False)
    browser.wait_until(lambda: commands[-1] == (0.0, 0.0) and KNOB not in browser.nodes)
    for phase in ('update', 'end'):
        drag(browser, joystick, phase)
    browser.read(0.2)
    assert commands[-1] == (0.0, 0.0)
    assert 'Traceback' not in capfd.readouterr().err


def test_each_browser_has_its_own(browser, joystick, site):
    with Browser(site.address) as second:
        second.choose('Joystick', True)
        second.wait_until(lambda: KNOB in second.nodes)
        browser.choose('Joystick', False)
        browser.wait_until(lambda: KNOB not in browser.nodes)
        second.read(0.1)
        assert KNOB in second.nodes
