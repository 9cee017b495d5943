"""What is selected in numbers, and what changes it."""

from dataclasses import replace

import pytest
from support.window import clock, selection

from rosbots_description.sim.core import Pose, SimError, Twist, from_rpy
from rosbots_description.sim.description import (
    Box,
    Collision,
    Cylinder,
    Inertial,
    JointSpec,
    Mesh,
    Plane,
    SceneChange,
    ShownLink,
    ShownModel,
    ShownSensor,
    Sphere,
    Surface,
)
from rosbots_description.web.controls import descriptions

BASE = ShownLink(
    1,
    'base',
    Pose((1.0, 0.0, 0.0)),
    collisions=(Collision('box', Box((1.0, 2.0, 0.5)), surface=Surface(0.5, 0.25)),),
    inertial=Inertial(4.0),
    sensors=(ShownSensor('eye<1>', 'camera'),),
)
WHEEL = ShownLink(
    2,
    'wheel',
    Pose(),
    collisions=(Collision('rim', Cylinder(0.2, 0.1)), Collision('hub', Sphere(0.1))),
    inertial=Inertial(1.5),
    gravity=False,
)
JOINT = JointSpec('axle', 'revolute', 'base', 'wheel', lower=-1.0, upper=2.0)
CART = ShownModel('cart', (BASE, WHEEL), (JOINT,))
GROUND = ShownModel(
    'ground',
    (ShownLink(3, 'link', Pose(), collisions=(Collision('plane', Plane()),)),),
    static=True,
)


@pytest.fixture
def world(browser, simulator):
    simulator.change(SceneChange(True, (CART, GROUND)))
    return browser


def visible(browser, label):
    """Return whether a button, and the folders around it, are shown."""
    uuid = browser.control(label)
    if uuid is None:
        return False
    while uuid in browser.controls:
        if not browser.controls[uuid][1]['visible']:
            return False
        uuid = browser.parents[uuid]
    return True


def test_numbers_are_shown_of_what_is_selected_and_asked_for_only_then(world, simulator, page):
    page.poll()
    assert simulator.told == []
    world.wait_until(lambda: world.shows('Click on a model'))
    simulator.where = (
        Pose((1.0, -2.0, 0.5), from_rpy(0.0, 0.0, 1.5)),
        Twist((0.25, 0.0, 0.0), (0.0, 0.0, -0.125)),
    )
    selection(page).choose('cart')
    page.poll()
    assert simulator.told == [('state', 'cart', None)]
    world.wait_until(lambda: '-2.000' in world.tables())
    shown = world.tables()
    for text in (
        '<b>cart</b>',
        '1.500',
        '0.250',
        '-0.125',
        '>5.5<',
        'each collision has its own',
        'Joints (1)',
        'axle: revolute, -1 to 2, base → wheel',
        'Collisions (3)',
        'box 1 x 2 x 0.5 m, mu 0.5, mu2 0.25',
        'cylinder, radius 0.2 m, length 0.1 m',
        'Sensors (1)',
        'eye&lt;1&gt;: camera',
    ):
        assert text in shown
    simulator.missing = ['plugin <b>']  # known by now
    selection(page).choose('cart', 'base')
    page.poll()
    assert simulator.told[-1] == ('state', 'cart', 'base')
    world.wait_until(lambda: '<b>cart::base</b>' in world.tables())
    shown = world.tables()
    assert 'Collisions (1)' in shown
    assert '0.5, 0.25' in shown
    simulator.change(SceneChange(models=(replace(CART),), removed=('cart',)))
    page.poll()
    world.wait_until(lambda: 'Spawned without (1)' in world.tables())
    assert '<li>plugin &lt;b&gt;</li>' in world.tables()
    selection(page).choose(None)
    world.wait_until(lambda: world.tables() == '')


def test_without_an_answer_the_last_numbers_stay(world, simulator, page, monkeypatch):
    selection(page).choose('cart')
    page.poll()
    monkeypatch.setattr(simulator, 'state', _gone)
    page.poll()
    world.wait_until(lambda: '<b>cart</b>' in world.tables())


def _gone(*_):
    raise SimError('it does not answer')


def type_in(browser, client, label, value):
    """Type into a field; return when the page knows it."""
    browser.choose(label, value)
    field = client.gui._gui_input_handle_from_uuid[browser.control(label)]
    browser.wait_until(lambda: field.value == value)


def test_what_is_typed_stays_while_other_properties_change(world, client, simulator, page):
    selection(page).choose('cart', 'base')
    world.wait_until(lambda: world.control('mu') and world.value('mu') == 0.5)
    type_in(world, client, 'mu', 0.75)
    heavier = replace(BASE, inertial=Inertial(8.0))
    simulator.change(SceneChange(models=(replace(CART, links=(heavier, WHEEL)),)))
    world.wait_until(lambda: world.value('Mass [kg]') == 8.0)
    world.click('Set friction')
    world.wait_until(lambda: ('set_friction', 'cart::base', 0.75, 0.25) in simulator.told)


def test_what_was_set_is_not_filled_in_again_when_the_simulator_shows_it(
    world, client, simulator, page
):
    selection(page).choose('cart', 'base')
    world.wait_until(lambda: world.control('Mass [kg]') and world.value('Mass [kg]') == 4.0)
    world.choose('Mass [kg]', 8.0)
    world.click('Set mass')
    world.wait_until(lambda: ('set_mass', 'cart', 'base', 8.0, True) in simulator.told)
    type_in(world, client, 'Mass [kg]', 3.0)
    heavier = replace(BASE, inertial=Inertial(8.0), gravity=False)
    simulator.change(SceneChange(models=(replace(CART, links=(heavier, WHEEL)),)))
    world.wait_until(lambda: world.value('Gravity') is False)
    world.click('Set mass')
    world.wait_until(lambda: ('set_mass', 'cart', 'base', 3.0, False) in simulator.told)


def test_pose_and_velocity_are_set_one_without_the_other_and_undone(world, simulator, page):
    now = Pose((1.0, 2.0, 3.0)), Twist((0.5, 0.0, 0.0))
    simulator.where = now
    simulator.motion(clock(_1=Pose((7.0, 0.0, 0.0))))
    world.wait_until(lambda: world.nodes.get('/models/cart/base', [0, 0])[1] == [7.0, 0.0, 0.0])
    selection(page).choose('cart', 'base')
    world.wait_until(lambda: world.value('Position [m]') == [7.0, 0.0, 0.0])
    world.choose('Position [m]', [4.0, 5.0, 6.0])
    world.choose('Roll, pitch, yaw [rad]', [0.0, 0.0, 1.0])
    world.click('Set pose')
    told = ('set_state', 'cart', 'base', Pose((4.0, 5.0, 6.0), from_rpy(0.0, 0.0, 1.0)), now[1])
    world.wait_until(lambda: told in simulator.told)
    world.click("Undo: pose of 'cart::base'")
    world.wait_until(lambda: ('set_state', 'cart', 'base', *now) in simulator.told)
    world.choose('Velocity [m/s]', [0.0, -1.0, 0.0])
    world.choose('Turning [rad/s]', [0.0, 0.0, 2.0])
    world.click('Set velocity')
    told = ('set_state', 'cart', 'base', now[0], Twist((0.0, -1.0, 0.0), (0.0, 0.0, 2.0)))
    world.wait_until(lambda: told in simulator.told)


def test_mass_and_gravity_of_a_link_are_set_and_undone(world, simulator, page):
    selection(page).choose('cart')
    world.wait_until(lambda: visible(world, 'Set velocity'))
    assert not visible(world, 'Set mass')  # of which link?
    selection(page).choose('cart', 'wheel')
    world.wait_until(lambda: visible(world, 'Set mass'))
    world.wait_until(lambda: (world.value('Mass [kg]'), world.value('Gravity')) == (1.5, False))
    world.choose('Mass [kg]', 2.5)
    world.click('Set mass')
    world.wait_until(lambda: ('set_mass', 'cart', 'wheel', 2.5, False) in simulator.told)
    wheel = replace(WHEEL, number=9, inertial=Inertial(2.5))
    simulator.change(SceneChange(models=(replace(CART, links=(BASE, wheel)),), removed=('cart',)))
    world.wait_until(lambda: '>2.5<' in world.tables())
    world.click("Undo: mass of 'cart::wheel'")
    world.wait_until(lambda: ('set_mass', 'cart', 'wheel', 1.5, False) in simulator.told)


def test_friction_is_set_of_all_collisions_and_undone_of_each(world, simulator, page):
    selection(page).choose('cart')
    world.wait_until(lambda: visible(world, 'Set friction'))
    world.choose('mu', 0.75)
    world.choose('mu2', 0.125)
    world.click('Set friction')
    world.wait_until(lambda: ('set_friction', 'cart', 0.75, 0.125) in simulator.told)
    world.wait_until(lambda: world.control("Undo: friction of 'cart'"))
    simulator.told.clear()
    world.click("Undo: friction of 'cart'")
    world.wait_until(lambda: len(simulator.told) == 3)
    assert simulator.told == [
        ('set_friction', 'cart::base::box', 0.5, 0.25),
        ('set_friction', 'cart::wheel::rim', 1.0, 1.0),
        ('set_friction', 'cart::wheel::hub', 1.0, 1.0),
    ]


def test_what_a_model_does_not_have_cannot_be_set(world, page):
    selection(page).choose('ground')
    world.wait_until(lambda: visible(world, 'Set pose'))
    world.wait_until(lambda: 'static' in world.tables())
    assert not visible(world, 'Set velocity')
    assert not visible(world, 'Set mass')
    assert visible(world, 'Set friction')


def test_a_refusal_is_shown_and_leaves_nothing_to_undo(world, simulator, page):
    selection(page).choose('cart', 'wheel')
    world.wait_until(lambda: visible(world, 'Set mass'))
    simulator.fault = 'SetLinkProperties: Failure - mass is -1.'
    world.choose('Mass [kg]', -1.0)
    world.click('Set mass')
    world.wait_until(lambda: world.notes() == [simulator.fault])
    assert world.control('Undo')


def test_long_lists_end_and_meshes_are_named():
    many = tuple(Collision(f'c{n}', Mesh('/folder/<x>.stl')) for n in range(150))
    listed = descriptions.parts_html(
        ShownModel('m', (ShownLink(1, 'l', Pose(), collisions=many),)), None
    )
    assert 'Collisions (150)' in listed
    assert 'and 50 more' in listed
    assert 'c99: mesh &lt;x&gt;.stl' in listed
    assert 'c100' not in listed
