"""Laws without an interface: PID, limits, angles, rates, parameters."""

import math
from itertools import pairwise

import pytest

from rosbots_description.sim.controllers import ControllerParameters, Gains, Pid, RateGate
from rosbots_description.sim.controllers.angles import position_error, shortest, shortest_within
from rosbots_description.sim.controllers.drive.odometry import PlanarOdometry
from rosbots_description.sim.controllers.limits import (
    EffortSaturation,
    EffortSoftLimits,
    JointLimits,
    PositionSaturation,
    VelocitySaturation,
    VelocitySoftLimits,
    read_limits,
)
from rosbots_description.sim.description import ControlledJoint, SoftLimits

DT = 0.001


def test_a_pid_adds_its_three_terms():
    pid = Pid(Gains(2.0, 3.0, 0.5, i_max=1.0, i_min=-1.0))
    assert pid.update(0.1, DT) == pytest.approx(2.0 * 0.1 + 3.0 * 0.1 * DT + 0.5 * 0.1 / DT)
    assert pid.update(0.1, DT) == pytest.approx(2.0 * 0.1 + 3.0 * 0.2 * DT)
    pid.reset()
    assert pid.update(0.1, DT, error_rate=-1.0) == pytest.approx(0.2 + 3e-4 - 0.5)


def test_the_integral_term_is_clamped_and_winds_up_only_without_antiwindup():
    for antiwindup, steps_back in ((False, 1000), (True, 0)):
        pid = Pid(Gains(0.0, 1.0, 0.0, 0.5, -0.5, antiwindup))
        for _ in range(2000):
            assert pid.update(1.0, DT) <= 0.5
        for _ in range(steps_back):
            assert pid.update(-1.0, DT) == pytest.approx(0.5)
        assert pid.update(-10.0, 0.05) == pytest.approx(0.5 if steps_back else 0.0, abs=1e-2)


@pytest.mark.parametrize('error', [math.nan, math.inf])
def test_a_pid_ignores_what_is_not_finite(error):
    pid = Pid(Gains(1.0, 1.0, 1.0))
    assert pid.update(error, DT) == 0.0
    assert pid.update(1.0, 0.0) == 0.0
    assert math.isfinite(pid.update(1.0, DT))


@pytest.mark.parametrize(
    ('given', 'bounds'),
    [
        ({'i_clamp': -2}, (2.0, -2.0)),
        ({'i_clamp': 2, 'i_clamp_min': 1}, (2.0, -1.0)),
        ({'i_clamp_max': 3, 'i_clamp_min': -1}, (3.0, -1.0)),
        ({}, (0.0, 0.0)),
    ],
)
def test_the_clamp_of_an_integral_is_read_as_upstream(given, bounds):
    gains = Pid.from_parameters(ControllerParameters({'p': 1, **given})).gains
    assert (gains.i_max, gains.i_min) == bounds


@pytest.mark.parametrize(
    ('start', 'end', 'way'),
    [(0.0, 3.0, 3.0), (3.0, -3.0, math.tau - 6.0), (-3.0, 3.0, 6.0 - math.tau)],
)
def test_the_shortest_way_may_cross_pi(start, end, way):
    assert shortest(start, end) == pytest.approx(way)


def test_a_limited_joint_goes_the_long_way_round():
    assert shortest_within(3.0, -3.0, -3.1, 3.1) == pytest.approx(-6.0)
    assert position_error('revolute', 3.0, -3.0, -3.1, 3.1) == pytest.approx(-6.0)
    assert position_error('continuous', 3.0, -3.0, -3.1, 3.1) == pytest.approx(math.tau - 6.0)
    assert position_error('prismatic', 3.0, -30.0, -50.0, 50.0) == -33.0


def test_a_position_moves_from_where_the_joint_was_at_the_limit_of_velocity():
    law = PositionSaturation(JointLimits('revolute', -1.0, 1.0, velocity=2.0))
    assert law.enforce(5.0, 0.5, 0.0, 0.1) == pytest.approx(0.7)
    assert law.enforce(5.0, -9.0, 0.0, 0.1) == pytest.approx(0.9)  # open loop, as upstream
    assert law.enforce(5.0, 0.0, 0.0, 0.1) == 1.0


def test_an_effort_does_not_push_beyond_a_limit():
    law = EffortSaturation(JointLimits('revolute', -1.0, 1.0, velocity=2.0, effort=10.0))
    assert law.enforce(50.0, 0.0, 0.0, DT) == 10.0
    assert law.enforce(50.0, 1.1, 0.0, DT) == 0.0
    assert law.enforce(-50.0, 1.1, 0.0, DT) == -10.0
    assert law.enforce(50.0, 0.0, 2.1, DT) == 0.0
    assert law.enforce(-50.0, 0.0, -2.1, DT) == 0.0


def test_soft_limits_bound_velocity_and_effort():
    soft = SoftLimits(-0.5, 0.5, k_position=4.0, k_velocity=3.0)
    limits = JointLimits('revolute', -1.0, 1.0, velocity=2.0, effort=10.0, soft=soft)
    velocity = VelocitySoftLimits(limits)
    assert velocity.enforce(5.0, 0.25, 0.0, DT) == pytest.approx(4.0 * 0.25)
    assert velocity.enforce(5.0, 0.75, 0.0, DT) == pytest.approx(-1.0)
    effort = EffortSoftLimits(limits)
    assert effort.enforce(50.0, 0.25, 0.5, DT) == pytest.approx(3.0 * (1.0 - 0.5))


def test_a_velocity_follows_at_the_limit_of_acceleration():
    law = VelocitySaturation(JointLimits(velocity=2.0, acceleration=10.0))
    assert law.enforce(5.0, 0.0, 0.0, 0.1) == 1.0
    assert law.enforce(5.0, 0.0, 0.0, 0.1) == 2.0
    assert law.enforce(5.0, 0.0, 0.0, 0.1) == 2.0


def test_no_limit_is_no_bound():
    limits = JointLimits()
    for law in (PositionSaturation(limits), EffortSaturation(limits), VelocitySaturation(limits)):
        assert law.enforce(1e6, 0.0, 0.0, DT) == 1e6


def test_parameters_add_and_remove_limits():
    described = ControlledJoint('revolute', -1.0, 1.0, 2.0, 3.0)
    limits = read_limits(
        described,
        ControllerParameters(
            {
                'has_position_limits': False,
                'has_velocity_limits': True,
                'max_velocity': 7,
                'has_effort_limits': True,
                'has_acceleration_limits': True,
                'max_acceleration': 5.0,
            }
        ),
    )
    assert (limits.lower, limits.upper) == (-math.inf, math.inf)
    assert (limits.velocity, limits.acceleration, limits.effort) == (7.0, 5.0, 3.0)


def test_a_gate_keeps_its_mean_rate():
    gate = RateGate(30.0)
    gate.start(0)
    opened = [now for now in range(1, 1001) if gate.opens(now * 1_000_000)]
    assert len(opened) == 31
    assert {b - a for a, b in pairwise(opened[1:])} == {33, 34}


def test_values_of_a_wrong_type_are_absent():
    params = ControllerParameters(
        {
            'a': {'b': 2, 'c': 'x', 'd': True, 'n': math.nan, 'l': ['p', 'q'], 'm': ['p', 1]},
            'huge': 10**400,
        },
        '/ns',
    )
    assert params.number('a/b') == 2.0
    assert params.number('a/d') is params.number('a/n') is params.number('huge') is None
    assert params.read('a/c', 5.0) == 5.0
    assert params.read('a/d', False) is True
    assert params.strings('a/l') == ['p', 'q']
    assert params.strings('a/m') is None
    assert params.section('a/b').find('x') is None
    assert params.section('a').namespace == '/ns/a'
    assert params.fill('<a/c>') == '5.0'


def test_odometry_integrates_arcs_exactly_and_ignores_what_is_not_finite():
    odometry = PlanarOdometry(10)
    odometry.advance(math.nan, 0.0, 1)
    steps = 90
    for step in range(1, steps + 1):
        odometry.advance(math.pi / 2.0 / steps, math.pi / 2.0 / steps, step * 10_000_000)
    assert (odometry.x, odometry.y) == pytest.approx((1.0, 1.0), abs=1e-12)
    assert odometry.heading == pytest.approx(math.pi / 2.0)
    assert odometry.velocity[0] == pytest.approx(math.pi / 2.0 / steps / 0.01)


@pytest.mark.parametrize('rate', [0.0, -1.0, 1e-300, math.inf])
def test_a_gate_of_an_absurd_rate_neither_fails_nor_floods(rate):
    gate = RateGate(rate)
    gate.start(0)
    assert not gate.opens(1_000_000)


def test_between_infinities_there_is_no_shortest_way():
    assert math.isnan(shortest(0.0, math.inf))
    assert math.isnan(shortest(math.inf, math.inf))
