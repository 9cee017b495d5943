"""Overlays of links, contacts, how visuals are drawn, and cameras that follow."""

import math

import numpy as np
import pytest
from support.browser import CAMERA, Browser
from support.patience import wait_until
from support.window import clock, model, selection

from rosbots_description.sim.core import Pose, from_rpy
from rosbots_description.sim.description import (
    Box,
    Collision,
    Inertial,
    JointSpec,
    Mesh,
    Plane,
    SceneChange,
    ShownContact,
    ShownLink,
    ShownModel,
)
from rosbots_description.web.scene.overlays import OVERLAYS, equal_box

TURNED = Pose((0.0, 0.0, 0.5), from_rpy(0.0, 0.0, math.pi / 2.0))
ARM = ShownLink(
    1,
    'arm',
    Pose(),
    collisions=(
        Collision('box', Box((1.0, 1.0, 1.0)), TURNED),
        Collision('gone', Mesh('/gone.stl')),
        Collision('plane', Plane()),
    ),
    inertial=Inertial(2.0, TURNED, 1.0, 1.0, 1.0),
)
ROBOT = ShownModel(
    'robot',
    (ARM, ShownLink(2, 'foot', Pose())),
    (JointSpec('shoulder', 'revolute', 'world', 'arm', Pose((0.0, 0.0, 1.0)), (0.0, 1.0, 0.0)),),
)
PLACES = {
    'Frames': {'': 'FrameMessage'},
    'Joint axes': {'': 'ArrowMessage'},
    'Collision shapes': {'': 'FrameMessage', '/0': 'GlbMessage'},
    'Centres of mass': {'': 'IcosphereMessage'},
    'Inertias': {'': 'BoxMessage'},
}


def nodes(browser, path):
    """Return the types of the nodes at and below a path."""
    return {
        name.removeprefix(path): state[0]
        for name, state in browser.nodes.items()
        if name.startswith(path)
    }


@pytest.mark.parametrize('name', OVERLAYS)
def test_what_is_checked_is_shown_as_a_part_of_each_link(browser, simulator, name):
    simulator.change(SceneChange(True, (ROBOT,)))
    path = f'/models/robot/arm/{name}'
    browser.wait_until(lambda: '/models/robot/arm' in browser.nodes)
    browser.choose(name, True)
    browser.wait_until(lambda: nodes(browser, path) == PLACES[name])
    assert (f'/models/robot/foot/{name}' in browser.nodes) == (name == 'Frames')
    browser.choose(name, False)
    browser.wait_until(lambda: nodes(browser, path) == {})


def test_models_that_come_or_change_get_it_too(browser, simulator):
    browser.choose('Centres of mass', True)
    simulator.change(SceneChange(True, (ROBOT,)))
    ball = '/models/robot/arm/Centres of mass'
    browser.wait_until(lambda: browser.nodes[ball][1] == [0.0, 0.0, 0.5])
    moved = ShownLink(5, 'arm', Pose(), inertial=Inertial(2.0, Pose((0.25, 0.0, 0.0))))
    simulator.change(SceneChange(models=(ShownModel('robot', (moved,)),), removed=('robot',)))
    browser.wait_until(lambda: browser.nodes.get(ball, [0, 0])[1] == [0.25, 0.0, 0.0])
    static = ShownModel('robot', (moved,), static=True)
    simulator.change(SceneChange(models=(static,), removed=('robot',)))
    browser.wait_until(lambda: ball not in browser.nodes)


def test_a_mark_is_not_seen_before_it_is_in_its_place(browser, simulator, monkeypatch):
    simulator.change(SceneChange(True, (model('a', 1),)))
    browser.choose('Frames', True)
    browser.wait_until(lambda: '/models/a/link/Frames' in browser.nodes)

    def slow(scene, path, _model, _link):
        mark = scene.add_frame(path)
        browser.read(0.2)  # all that viser sends meanwhile, sixty times a second
        mark.position = (1.0, 2.0, 3.0)

    monkeypatch.setitem(OVERLAYS, 'Frames', slow)
    simulator.change(SceneChange(models=(model('b', 2),)))
    browser.wait_until(lambda: '/models/b/link/Frames' in browser.nodes)
    assert browser.nodes['/models/b/link/Frames'][1] == [1.0, 2.0, 3.0]


def test_only_what_is_selected_is_marked_if_that_is_asked_for(browser, simulator, page):
    simulator.change(SceneChange(True, (ROBOT, model('other', 9))))
    browser.choose('Only of what is selected', True)
    browser.choose('Frames', True)
    selection(page).choose('robot')
    browser.wait_until(lambda: '/models/robot/foot/Frames' in browser.nodes)
    assert '/models/other/link/Frames' not in browser.nodes
    selection(page).choose('robot', 'arm')
    browser.wait_until(lambda: '/models/robot/foot/Frames' not in browser.nodes)
    assert '/models/robot/arm/Frames' in browser.nodes


def test_a_box_has_the_inertia_that_it_shows():
    x, y, z, mass = 1.0, 2.0, 3.0, 12.0
    given = Inertial(mass, TURNED, y * y + z * z, x * x + z * z, x * x + y * y)
    size, orientation = equal_box(given)
    assert size == pytest.approx((x, y, z))
    assert orientation == pytest.approx(TURNED.orientation)
    size, _ = equal_box(Inertial(1.0, ixx=1.0, iyy=1.0, izz=2.5))  # no body has that
    assert size[2] == 0.0


@pytest.mark.parametrize('look', ['transparent', 'wireframe'])
def test_visuals_are_drawn_in_another_way_but_grounds(browser, simulator, look):
    simulator.change(SceneChange(True, (model('a', 1), model('ground', 2, Plane()))))
    browser.wait_until(lambda: '/models/ground/link/0 v/grid' in browser.nodes)
    for value in (look, 'solid'):
        browser.choose('Visuals', value)
        before = len(files(browser, '/models/a'))
        browser.wait_until(lambda before=before: len(files(browser, '/models/a')) > before)
    assert len(set(files(browser, '/models/a'))) == 2
    assert len(set(files(browser, '/models/ground'))) == 1


def files(browser, path):
    """Return the contents of all files that a browser got below a path."""
    return [
        bytes(m['props']['glb_data'])
        for m in browser.received('GlbMessage')
        if m['name'].startswith(path)
    ]


def test_contacts_are_asked_for_only_while_they_are_shown(browser, simulator, site, page):
    assert simulator.contacts.show is None
    browser.choose('Contacts and forces', True)
    browser.wait_until(lambda: simulator.contacts.show)
    up, down = (0.0, 0.0, 10.0), (5.0, 0.0, -10.0)
    simulator.contacts.show([contact(1.0, up), contact(2.0, down)])
    browser.wait_until(lambda: '/contacts/forces' in browser.nodes)
    points = site.scene.get_handle_by_name('/contacts/points')
    lines = site.scene.get_handle_by_name('/contacts/forces')
    assert np.allclose(points.points, [(1.0, 0.0, 0.0), (2.0, 0.0, 0.0)])
    # The greatest force is half a metre long; both point up, as on the upper bodies.
    assert browser.value('Force per metre [N]') == 20.0
    assert np.allclose(lines.points[:, 1] - points.points, [(0.0, 0.0, 0.5), (-0.25, 0.0, 0.5)])
    simulator.contacts.show([contact(3.0, up)])
    assert np.allclose(points.points, [(3.0, 0.0, 0.0)])
    browser.choose('Force per metre [N]', 5.0)
    browser.wait_until(lambda: length_after(simulator, lines, up) == pytest.approx(2.0))
    simulator.contacts.show([])
    browser.wait_until(lambda: '/contacts/points' not in browser.nodes)
    simulator.contacts.show([contact(3.0, up)])  # it jumped
    browser.wait_until(lambda: '/contacts/points' in browser.nodes)
    lines = site.scene.get_handle_by_name('/contacts/forces')
    assert length_after(simulator, lines, up) == pytest.approx(2.0)  # as it was set
    browser.choose('Contacts and forces', False)
    browser.wait_until(lambda: simulator.contacts.show is None)


def contact(x, force):
    return ShownContact((x, 0.0, 0.0), (0.0, 0.0, 1.0), force)


def length_after(simulator, lines, force):
    simulator.contacts.show([contact(3.0, force)])
    return float(np.linalg.norm(lines.points[0, 1] - lines.points[0, 0]))


def test_nobody_who_looks_needs_contacts(browser, simulator, site, page):
    browser.choose('Contacts and forces', True)
    browser.wait_until(lambda: simulator.contacts.show)
    browser.__exit__()
    wait_until(lambda: simulator.contacts.show is None)
    with Browser(site.address) as later:
        later.wait_until(lambda: simulator.contacts.show)


def test_cameras_follow_the_selected_model_and_keep_the_offset(browser, client, simulator, page):
    simulator.change(SceneChange(True, (model('a', 1),)))
    selection(page).choose('a')
    browser.click('Follow the selection')
    browser.wait_until(lambda: browser.control('Stop following'))
    browser.send(CAMERA | {'position': [3.0, 0.0, 2.0], 'look_at': [1.0, 0.0, 1.0]})
    browser.wait_until(lambda: tuple(client.camera.position) == (3.0, 0.0, 2.0))
    simulator.motion(clock(_1=Pose((10.0, 5.0, 0.0))))
    browser.wait_until(lambda: browser.view() == ([12.0, 5.0, 1.0], [10.0, 5.0, 0.0]))
    told = len(browser.messages)
    simulator.motion(clock(_1=Pose((10.0, 5.0, 0.0001))))  # it rests
    browser.read()
    assert not [m for m in browser.messages[told:] if m['type'].startswith('SetCamera')]
