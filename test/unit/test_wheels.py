"""Driven wheels lag and creep by the force they pass on; what is dragged holds in curves."""

import math
from dataclasses import replace

import pytest
from support.fake_drive import PERIOD_STEPS, collect, make, rim_speeds, run, wheel_of

from rosbots_description.sim.body import HOLDS_ALL
from rosbots_description.sim.plugins.diff_drive import REACHED
from rosbots_description.sim.pose import Pose, Twist, from_rpy
from rosbots_description.sim.sliding import ROLLS
from rosbots_description.sim.wheel import CREEP, LAG


def test_a_loaded_wheel_that_pulls_creeps_and_reports_its_hub():
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0', wheelTorque='1.3')
    plugin.command(0.52, 0.0)
    run(plugin, PERIOD_STEPS + 1)
    for wheel in plugin.model.wheels.values():
        wheel.weight, wheel.effort = 10.0, 1.3  # it pulls at half of its grip
    run(plugin, 100 * PERIOD_STEPS)  # the creep follows slowly
    assert rim_speeds(plugin) == pytest.approx((0.52 - 0.25 * CREEP,) * 2)
    assert plugin.wheels[0].velocity == pytest.approx(2.0)
    plugin.config = replace(plugin.config, publish_wheel_joint_state=True)
    states = collect(plugin.joint_states)
    run(plugin, 2 * PERIOD_STEPS)
    turned = states[1].positions[0] - states[0].positions[0]
    assert turned == pytest.approx(2.0 * 0.010)  # as the hub does


def test_driven_wheels_are_let_to_roll():
    plugin = make()
    run(plugin, PERIOD_STEPS + 1)
    assert plugin.model.rolling == {'left_link', 'right_link'}


def test_a_wheel_that_is_asked_to_stand_does_not_creep():
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0')
    for wheel in plugin.model.wheels.values():
        wheel.weight, wheel.effort = 10.0, 1.3  # parked on a slope
    run(plugin, 100 * PERIOD_STEPS)
    assert rim_speeds(plugin) == (0.0, 0.0)


def test_a_motor_that_falls_behind_is_brought_to_the_lag_of_its_force():
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0', wheelTorque='20')
    for wheel, given in zip(plugin.model.wheels.values(), (0.99, 0.97), strict=True):
        wheel.weight, wheel.gives = 10.0, lambda asked, share=given: (share * asked, 1.3)
    plugin.model.ground = 0.49
    plugin.command(0.52, 0.0)
    run(plugin, 800 * PERIOD_STEPS)
    for wheel in plugin.wheels:  # both pull at half of their grip
        assert wheel.velocity == pytest.approx(2.0 - 0.5 * LAG / 0.26)


def test_however_hard_it_pulls_a_motor_does_not_lag_by_what_a_drive_would_make_up_for():
    plugin = make(wheel_collisions=wheel_of(0.26), wheelTorque='20')
    for wheel in plugin.model.wheels.values():
        wheel.weight, wheel.gives = 10.0, lambda asked: (0.99 * asked, 2.6)  # all of its grip
    plugin.command(0.52, 0.0)
    run(plugin, 800 * PERIOD_STEPS)
    for wheel in plugin.wheels:
        assert 0.0 < 0.52 - 0.26 * wheel.velocity < REACHED


def pulling(weights, efforts):
    """Return a plugin whose wheels carry these loads [N] and pull as hard as these efforts."""
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0', wheelTorque='20')
    plugin.model.ground = 0.51
    for wheel, weight, effort in zip(plugin.model.wheels.values(), weights, efforts, strict=True):
        wheel.weight, wheel.gives = weight, lambda asked, effort=effort: (asked, effort)
    return plugin


def test_on_the_straight_both_wheels_give_way_by_the_grip_that_both_use():
    plugin = pulling((10.0, 30.0), (1.3, 1.3))  # 5 N each, 40 N of grip together
    plugin.command(0.52, 0.0)
    run(plugin, 800 * PERIOD_STEPS)
    given_way = 0.25 * LAG + 0.25**2 * CREEP
    assert rim_speeds(plugin) == pytest.approx((0.52 - given_way,) * 2)


def test_in_a_curve_each_wheel_gives_way_by_its_own_grip():
    plugin = pulling((10.0, 20.0), (1.3, 1.3))
    plugin.command(1.1, 1.0)
    run(plugin, 800 * PERIOD_STEPS)
    left = 1.1 - 0.55 - 0.5 * LAG - 0.5**2 * CREEP
    right = 1.1 + 0.55 - 0.25 * LAG - 0.25**2 * CREEP
    assert rim_speeds(plugin) == pytest.approx((left, right))


def test_a_joint_that_was_put_elsewhere_has_not_fallen_behind():
    plugin = pulling((0.0, 0.0), (0.0, 0.0))
    plugin.command(0.52, 0.0)
    run(plugin, 100 * PERIOD_STEPS)
    plugin.model.wheels['left'].position = 0.0
    run(plugin, 100 * PERIOD_STEPS)
    assert rim_speeds(plugin) == pytest.approx((0.52, 0.52))


def test_a_motor_that_gives_all_it_has_is_not_asked_for_ever_more():
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0', wheelTorque='1')
    for wheel in plugin.model.wheels.values():
        wheel.gives = lambda asked: (0.0, 1.0)  # it stands against a wall
    plugin.command(0.52, 0.0)
    run(plugin, 400 * PERIOD_STEPS)
    for wheel in plugin.model.wheels.values():
        wheel.gives = lambda asked: (asked, 0.0)  # the wall is gone
    run(plugin, PERIOD_STEPS)
    assert rim_speeds(plugin) == pytest.approx((0.52, 0.52))


@pytest.mark.parametrize('speed', [1e308, -1e308, 1e6])
def test_a_motor_asked_for_the_impossible_is_soon_itself_again(speed):
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0', wheelTorque='20')
    for wheel in plugin.model.wheels.values():
        wheel.gives = lambda asked: (min(50.0, max(-50.0, asked)), 1.3)
    plugin.command(speed, 0.0)
    run(plugin, 20 * PERIOD_STEPS)
    plugin.command(0.52, 0.0)
    run(plugin, 400 * PERIOD_STEPS)
    assert rim_speeds(plugin) == pytest.approx((0.52, 0.52), abs=1e-4)


@pytest.mark.parametrize(
    ('command', 'share'),
    [
        ((0.0, 0.0), 1.0),  # at rest everything holds
        ((0.5, 0.0), 0.0),
        ((-0.5, 0.0), 0.0),
        ((0.5, 0.5), 1.0),
        ((-0.5, 0.5), 1.0),
        ((0.0, 1.0), 1.0),
        ((1.1, 0.1), 0.01),  # the rims differ by 0.11 m/s of 2.2
        ((1.1, 0.5), 0.25),
        ((1.1, -0.5), 0.25),
    ],
)
def test_what_a_robot_drags_holds_sideways_in_curves_and_at_rest(command, share):
    plugin = make(wheelAcceleration='0')
    plugin.command(*command)
    run(plugin, PERIOD_STEPS + 1)
    assert plugin.model.holds['base'].sideways == pytest.approx(share)


@pytest.mark.parametrize(('force', 'share'), [(4.0, 1.0), (5.5, 0.5), (7.0, 0.0), (20.0, 0.0)])
def test_what_a_robot_drags_lets_go_before_it_holds_the_robot_for_good(force, share):
    plugin = pulling((10.0, 10.0), (force * 0.26, -force * 0.26))
    plugin.command(0.0, 1.0)
    run(plugin, 500 * PERIOD_STEPS)
    assert plugin.model.holds['base'].sideways == pytest.approx(share, abs=0.01)
    plugin.command(0.0, 0.0)  # it stands, held on a slope, say
    run(plugin, 200 * PERIOD_STEPS)
    assert plugin.model.holds['base'] == HOLDS_ALL


@pytest.mark.parametrize('heading', [0.0, 0.4, math.pi / 4.0, 2.0, -2.5])
def test_straight_on_what_slides_is_held_back_alike_at_any_heading(heading):
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0')
    plugin.model.now = (Pose(orientation=from_rpy(0.0, 0.0, heading)), Twist())
    plugin.command(0.52, 0.0)
    run(plugin, PERIOD_STEPS + 1)
    limits = abs(math.cos(heading)) + abs(math.sin(heading))  # along the world's axes, together
    for hold in plugin.model.holds.values():
        assert hold.ahead * limits == pytest.approx(1.0, abs=0.01)
    plugin.command(0.5, 0.5)
    run(plugin, PERIOD_STEPS)
    assert set(plugin.model.holds.values()) == {HOLDS_ALL}


@pytest.mark.parametrize('command', [(1e308, 1e308), (1e-320, 0.0), (0.0, 1e-320)])
def test_no_command_asks_for_a_share_that_is_none(command):
    plugin = make(wheelAcceleration='0')
    plugin.command(*command)
    run(plugin, PERIOD_STEPS + 1)
    assert all(0.0 <= share <= 1.0 for share in plugin.model.holds['base'])


def test_a_wheel_that_nothing_rests_on_does_not_creep():
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0')
    for wheel in plugin.model.wheels.values():
        wheel.effort = 1.3
    plugin.command(0.52, 0.0)
    run(plugin, 10 * PERIOD_STEPS)
    assert rim_speeds(plugin) == pytest.approx((0.52, 0.52))


def tyres(plugin):
    """Return how much each tyre holds along the axle."""
    holds = plugin.model.holds
    return [holds.get(f'{side}_link', HOLDS_ALL).sideways for side in ('left', 'right')]


def test_tyres_hold_nothing_sideways_while_they_slide_straight_on():
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0')
    plugin.command(0.52, 0.0)
    run(plugin, PERIOD_STEPS + 1)
    assert tyres(plugin) == [0.0, 0.0]
    plugin.model.ground = 0.4
    run(plugin, PERIOD_STEPS)
    assert tyres(plugin) == [0.0, 0.0]
    plugin.model.ground = 0.515
    run(plugin, ROLLS * PERIOD_STEPS)
    assert tyres(plugin) == [1.0, 1.0]


def test_tyres_that_begin_to_slide_later_hold_nothing_sideways_either():
    plugin = driving()
    assert tyres(plugin) == [1.0, 1.0]
    plugin.model.ground = 0.0  # somebody holds it, or it comes down from a hop
    run(plugin, 6 * PERIOD_STEPS)  # a look
    assert tyres(plugin) == [0.0, 0.0]
    plugin.model.ground = 0.52  # as fast as the tyres, maybe for a moment only
    run(plugin, (ROLLS - 1) * PERIOD_STEPS)
    assert tyres(plugin) == [0.0, 0.0]
    run(plugin, PERIOD_STEPS)
    assert tyres(plugin) == [1.0, 1.0]


def test_tyres_that_slide_as_the_robot_turns_on_the_spot_hold():
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0')
    plugin.command(0.0, 1.0)
    run(plugin, 5 * PERIOD_STEPS)
    assert tyres(plugin) == [1.0, 1.0]


def test_tyres_that_roll_hold():
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0')
    plugin.model.ground = 0.52
    plugin.command(0.52, 0.0)
    run(plugin, (ROLLS + 2) * PERIOD_STEPS)
    assert tyres(plugin) == [1.0, 1.0]


def test_tyres_of_a_robot_that_keeps_up_as_they_speed_up_hold_all_the_time():
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='1')
    plugin.command(0.52, 0.0)
    for _ in range(60):
        run(plugin, PERIOD_STEPS)
        plugin.model.ground = rim_speeds(plugin)[0]
        assert tyres(plugin) == [1.0, 1.0]


def test_tyres_hold_again_beside_a_wheel_of_unknown_radius():
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0')
    plugin.wheels[1].radius = None
    plugin.command(0.52, 0.0)
    run(plugin, PERIOD_STEPS + 1)
    assert tyres(plugin) == [0.0, 0.0]
    plugin.model.ground = 0.515
    run(plugin, ROLLS * PERIOD_STEPS)
    assert tyres(plugin) == [1.0, 1.0]


def test_a_reset_lets_tyres_hold():
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0')
    plugin.command(0.52, 0.0)
    run(plugin, PERIOD_STEPS + 1)
    plugin.reset()
    assert tyres(plugin) == [1.0, 1.0]


def test_what_tyres_that_slide_do_to_their_motors_is_forgotten():
    plugin, shares = driving(), (0.99, 0.97)
    for wheel, share in zip(plugin.model.wheels.values(), shares, strict=True):
        wheel.gives = lambda asked, share=share: (share * asked, 1.3)
    run(plugin, 600 * PERIOD_STEPS)  # they roll: their motors are asked for what they owe
    assert rim_speeds(plugin) == pytest.approx((0.52, 0.52), abs=1e-3)
    plugin.model.ground = 0.0
    run(plugin, 600 * PERIOD_STEPS)
    assert rim_speeds(plugin) == pytest.approx([0.52 * share for share in shares], abs=1e-3)


def driving():
    """Return a plugin whose robot drives straight on and rolls, and whose motors have no load."""
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0')
    for wheel in plugin.model.wheels.values():
        wheel.gives = lambda asked: (asked, 0.0)
    plugin.model.ground = 0.52
    plugin.command(0.52, 0.0)
    run(plugin, 10 * PERIOD_STEPS)
    return plugin


def test_wheels_that_do_as_they_are_asked_are_left_alone_but_for_looks():
    plugin, told = driving(), []
    plugin.model.wheels['left'].gives = lambda asked: told.append(asked) or (asked, 0.0)
    run(plugin, 10 * PERIOD_STEPS)  # two looks
    assert told == pytest.approx([2.0, 2.0])
    plugin.command(0.26, 0.0)
    run(plugin, PERIOD_STEPS)
    assert told[2:] == pytest.approx([1.0])


def test_wheels_of_a_body_that_was_made_anew_are_told_everything_at_once():
    plugin = driving()
    plugin.model.body = object()
    plugin.model.rolling.clear()
    run(plugin, PERIOD_STEPS)
    assert plugin.model.rolling == {'left_link', 'right_link'}


def turning(plugin, rate):
    """Let the robot turn at that rate [rad/s], whatever its wheels do, for two seconds."""
    for k in range(40):
        plugin.model.now = (Pose((0.0, 0.0, 0.0), from_rpy(0.0, 0.0, 0.05 * rate * k)), Twist())
        run(plugin, 5 * PERIOD_STEPS)


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_what_the_solver_lets_a_robot_turn_by_its_wheels_make_up_for(sign):
    plugin = driving()
    turning(plugin, 0.002 * sign)  # of wheels 0.8 m apart: 0.8 mm/s each
    left, right = rim_speeds(plugin)
    assert sign * (left - 0.52) == pytest.approx(0.8e-3, rel=0.1)
    assert sign * (0.52 - right) == pytest.approx(0.8e-3, rel=0.1)
    turning(plugin, 0.0)
    assert rim_speeds(plugin) == pytest.approx((0.52, 0.52), abs=1e-4)


def test_what_turns_a_robot_by_more_is_no_matter_of_its_wheels():
    plugin = driving()
    turning(plugin, 0.02)
    assert rim_speeds(plugin) == pytest.approx((0.52, 0.52), abs=1e-4)


@pytest.mark.parametrize('command', [(0.52, 0.5), (0.0, 0.5), (0.0, 0.0)])
def test_in_curves_and_at_rest_wheels_make_up_for_nothing(command):
    plugin = make(wheel_collisions=wheel_of(0.26), wheelAcceleration='0')
    plugin.command(*command)
    run(plugin, 10 * PERIOD_STEPS)
    before = rim_speeds(plugin)
    turning(plugin, 0.002)
    assert rim_speeds(plugin) == pytest.approx(before, abs=1e-6)


@pytest.mark.parametrize(('lean', 'end'), [(0.0, 0.0), (0.01, -0.05), (-0.01, 0.05)])
def test_a_wheel_that_leans_touches_with_its_lower_end(lean, end):
    shape = replace(wheel_of(0.26)[0], pose=Pose(orientation=from_rpy(lean, 0.0, 0.0)))
    shape = replace(shape, geometry=replace(shape.geometry, length=0.1))
    for wheel in make(wheel_collisions=(shape,)).wheels:
        _, middle, _ = wheel.place_on_axle()
        _, touches, _ = wheel.touches_on_axle()
        assert touches - middle == pytest.approx(end, abs=1e-4)
