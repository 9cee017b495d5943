"""What holds a robot sideways while its tyres slide straight on."""

import pytest
from support.fake_drive import BASE, PERIOD_STEPS, STEP, WHEEL, make, run, wheel_of

from rosbots_description.sim.body import Contact

MASS = BASE.mass + 2.0 * WHEEL.mass  # [kg]
LEFT, RIGHT = (0.0, 0.4, -0.06), (0.0, -0.4, -0.06)  # where tyres touch [m]


def sliding(command=(0.52, 0.0), contacts=None):
    """Return a plugin whose tyres began to slide; by name of a link, places and friction [N]."""
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0')
    for wheel in plugin.model.wheels.values():
        wheel.gives = lambda asked: (asked, 0.0)
    plugin.model.contacts = {
        link: [Contact(place, force) for place, force in touches]
        for link, touches in (contacts or {}).items()
    }
    plugin.command(*command)
    run(plugin, PERIOD_STEPS + 1)
    return plugin


def both_tyres(friction):
    """Return the contacts of tyres that the ground pulls ahead with these forces [N]."""
    force = (friction, 0.0, 0.0)
    return {'left_link': [(LEFT, force)], 'right_link': [(RIGHT, force)]}


def change_of(plugin):
    """Return by how much the next look changes the speed aside [m/s] and the turning [rad/s]."""
    plugin.model.pushes.clear()
    run(plugin, PERIOD_STEPS)
    (force, torque), = plugin.model.pushes
    assert force[0] == force[2] == torque[0] == torque[1] == 0.0
    izz = BASE.izz + 2.0 * (WHEEL.iyy + WHEEL.mass * 0.4**2)  # a wheel's y axis is upright
    return force[1] * STEP / MASS, torque[2] * STEP / izz


@pytest.mark.parametrize('aside', [0.01, -0.01, 0.3])
def test_friction_sideways_is_to_that_ahead_as_the_slips_are(aside):
    plugin = sliding(contacts=both_tyres(5.0))
    plugin.model.aside = aside
    held = 2.0 * 5.0 / (0.52**2 + aside**2) ** 0.5 * PERIOD_STEPS * STEP / MASS
    # By the motion that is left at the end of the time.
    assert change_of(plugin) == pytest.approx((-aside * held / (1.0 + held), 0.0))


def test_however_much_holds_nothing_is_pushed_back():
    plugin = sliding(contacts=both_tyres(1e9))
    plugin.model.aside = 0.1
    assert change_of(plugin) == pytest.approx((-0.1, 0.0), rel=1e-3)


def test_what_is_dragged_holds_a_robot_that_turns():
    plugin = sliding(contacts={'base': [((-0.3, 0.0, 0.0), (-2.0, 0.0, 0.0))]})
    plugin.model.ground, plugin.model.turns = 0.4, 0.1
    aside, turned = change_of(plugin)
    assert aside > 0.0  # its tail moves to the other side
    assert -0.1 < turned < 0.0


def test_turning_about_what_touches_moves_nothing_aside():
    plugin = sliding(contacts=both_tyres(5.0))
    plugin.model.turns = 0.1
    assert change_of(plugin) == pytest.approx((0.0, 0.0), abs=1e-9)


def test_walls_hold_nothing():
    plugin = sliding(contacts={'base': [((0.5, 0.0, 0.1), (0.0, 3.0, 4.0))]})
    plugin.model.aside = 0.1
    assert change_of(plugin) == (0.0, 0.0)


def test_in_a_curve_the_engine_holds_a_share():
    straight, curve = (sliding(command, both_tyres(5.0)) for command in ((0.5, 0.0), (0.5, 0.2)))
    changes = []
    for plugin in (straight, curve):
        plugin.model.aside = 0.001
        changes.append(change_of(plugin)[0])
    bend = (0.22 / 0.5) ** 2  # the rims differ by 0.22 m/s of 1
    slower = (0.5 / 0.39 + 0.5 / 0.61) / 2.0
    assert changes[1] == pytest.approx((1.0 - bend) * slower * changes[0], rel=0.01)


@pytest.mark.parametrize('command', [(0.0, 1.0), (0.0, 0.0)])
def test_nobody_is_pushed_on_the_spot_or_at_rest(command):
    plugin = sliding(command, both_tyres(5.0))
    plugin.model.aside = 0.1
    run(plugin, 3 * PERIOD_STEPS)
    assert not plugin.model.pushes


def test_nobody_is_pushed_whose_tyres_roll_nor_for_the_time_before_they_slid():
    plugin = sliding(contacts=both_tyres(5.0))
    plugin.model.aside = 0.1
    plugin.model.ground = 0.52
    run(plugin, 20 * PERIOD_STEPS)
    plugin.model.pushes.clear()
    run(plugin, 20 * PERIOD_STEPS)
    assert not plugin.model.pushes
    plugin.model.ground = 0.0
    while not plugin.model.pushes:
        run(plugin, PERIOD_STEPS)
    first, = plugin.model.pushes
    change_of(plugin)
    assert plugin.model.pushes == [first]  # for as long a time


def test_what_is_dragged_by_motors_that_give_all_they_have_is_held():
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0', wheelTorque='5')
    plugin.model.ground, plugin.model.aside = 0.26, 0.1
    plugin.model.contacts = {'base': [Contact((-0.3, 0.0, 0.0), (-2.0, 0.0, 0.0))]}
    for wheel in plugin.model.wheels.values():
        wheel.gives = lambda asked: (0.5 * asked, 5.0)
    plugin.command(0.52, 0.0)
    run(plugin, 20 * PERIOD_STEPS)
    assert change_of(plugin)[0] < 0.0
    for wheel in plugin.model.wheels.values():
        wheel.gives = lambda asked: (asked, 2.0)
    plugin.model.ground = 0.52
    run(plugin, 20 * PERIOD_STEPS)
    plugin.model.pushes.clear()
    run(plugin, 20 * PERIOD_STEPS)
    assert not plugin.model.pushes


def test_nobody_is_pushed_who_lies_on_the_side():
    plugin = sliding(contacts=both_tyres(5.0))
    base = plugin.model.links['base']
    pose, twist = base.state()
    base.state = lambda: (pose._replace(orientation=(2**-0.5, 0.0, 0.0, 2**-0.5)), twist)
    plugin.model.pushes.clear()
    run(plugin, PERIOD_STEPS)
    assert not plugin.model.pushes
