"""Planar movement: what velocity it sets when, and what odometry tells of it."""

import math

import pytest
from support.fake_drive import FakeModel, collect, make_drive, run

from rosbots_description.sim.plugins.planar_move import PlanarMove
from rosbots_description.sim.pose import Pose, from_rpy


def make(**tags):
    return make_drive(PlanarMove, FakeModel(), **tags)


def test_all_tags_have_upstreams_defaults_and_its_warnings(caplog):
    plugin = make()
    config = plugin.config
    assert (config.command_topic, config.odometry_topic) == ('cmd_vel', 'odom')
    assert (config.odometry_frame, config.robot_base_frame) == ('odom', 'base_footprint')
    assert (config.update_rate, config.command_timeout, plugin.namespace) == (20.0, -1.0, '')
    assert 'PlanarMovePlugin (ns = ) missing <cmdTimeout>, defaults to -1.000000' in caplog.messages


def test_the_velocity_is_set_at_every_step_in_the_models_own_axes():
    plugin = make()
    plugin.model.now = (Pose((0.0, 0.0, 0.0), from_rpy(0.0, 0.0, math.pi / 2.0)), None)
    plugin.command(0.5, 0.3, 0.2)
    run(plugin, 1)
    twist = plugin.model.now[1]
    assert twist.linear == pytest.approx((-0.2, 0.5, 0.0))
    assert twist.angular == (0.0, 0.0, 0.3)


def test_odometry_at_20_hz_comes_each_51_ms():
    plugin = make()
    times = []
    plugin.odometry.connect(lambda _: times.append(plugin.world.clock.steps), lambda: True)
    run(plugin, 210)
    assert times == [51, 102, 153, 204]


def test_a_rate_of_zero_means_no_odometry():
    plugin = make(odometryRate='0')
    odometry = collect(plugin.odometry)
    run(plugin, 200)
    assert not odometry
    assert not plugin.sends_odometry


def test_the_twist_is_told_from_two_poses():
    plugin = make()
    odometry = collect(plugin.odometry)
    plugin.command(0.0, 1.0)
    yaws = (math.pi - 0.01, -math.pi + 0.02)  # it passes the back
    for k, yaw in enumerate(yaws):
        plugin.model.now = (Pose((0.0, -0.1 * k, 0.0), from_rpy(0.0, 0.0, yaw)), None)
        run(plugin, 51)
    linear, angular = odometry[-1].twist
    assert angular[2] == pytest.approx(0.03 / 0.051)
    assert linear[0] == pytest.approx(0.1 / 0.051 * math.sin(0.02), rel=1e-3)
    assert linear[1] == pytest.approx(0.1 / 0.051 * math.cos(0.02), rel=1e-3)


def test_who_turns_too_fast_to_tell_is_said_to_turn_as_commanded():
    plugin = make()
    odometry = collect(plugin.odometry)
    plugin.command(0.0, 100.0)
    run(plugin, 51)
    assert odometry[-1].twist.angular[2] == 100.0


def test_a_command_is_forgotten_after_its_timeout():
    plugin = make(cmdTimeout='0.1')
    plugin.command(0.5, 0.0)
    run(plugin, 100)
    assert plugin.model.now[1].linear[0] == 0.5
    run(plugin, 1)
    assert plugin.model.now[1].linear[0] == 0.0


def test_a_command_without_timeout_holds_and_a_reset_leaves_it():
    plugin = make()
    plugin.command(0.5, 0.0)
    plugin.reset()
    run(plugin, 5000)
    assert plugin.model.now[1].linear[0] == 0.5
