"""Planar movement: velocity, timing and odometry."""

import math

import pytest
from support.fake_drive import collect, fake_model, make_drive, place, run

from rosbots_description.sim.core.transforms import Pose, from_rpy
from rosbots_description.sim.plugins.drive.planar_move import PlanarMove


def make(**tags):
    return make_drive(PlanarMove, fake_model(), **tags)


def test_all_tags_have_upstreams_defaults_and_its_warnings(caplog):
    plugin = make()
    assert plugin.params.values == {
        'commandTopic': 'cmd_vel',
        'odometryTopic': 'odom',
        'odometryFrame': 'odom',
        'robotBaseFrame': 'base_footprint',
        'odometryRate': 20.0,
        'cmdTimeout': -1.0,
    }
    assert plugin.namespace == ''
    assert 'PlanarMovePlugin (ns = ) missing <cmdTimeout>, defaults to -1.000000' in caplog.messages


def test_the_velocity_is_set_at_every_step_in_the_models_own_axes():
    plugin = make()
    place(plugin, Pose((0.0, 0.0, 0.0), from_rpy(0.0, 0.0, math.pi / 2.0)))
    plugin.command(0.5, 0.3, 0.2)
    run(plugin, 1)
    twist = plugin.model.twist
    assert twist.linear == pytest.approx((-0.2, 0.5, 0.0))
    assert twist.angular == (0.0, 0.0, 0.3)


def test_odometry_at_20_hz_has_a_period_of_51_ms():
    plugin = make()
    times = []
    plugin.odometry.connect(lambda _: times.append(plugin.world.clock.steps))
    run(plugin, 210)
    assert times == [51, 102, 153, 204]


@pytest.mark.parametrize(
    ('rate', 'outputs'), [('0', set()), ('0.5', {'odometry', 'odometry_transform'})]
)
def test_only_a_rate_of_zero_disables_odometry(rate, outputs):
    assert make(odometryRate=rate).outputs.keys() == outputs


def test_twist_is_the_difference_of_two_poses():
    plugin = make()
    odometry = collect(plugin.odometry)
    plugin.command(0.0, 1.0)
    yaws = (math.pi - 0.01, -math.pi + 0.02)  # across the wrap of yaw
    for k, yaw in enumerate(yaws):
        place(plugin, Pose((0.0, -0.1 * k, 0.0), from_rpy(0.0, 0.0, yaw)))
        run(plugin, 51)
    linear, angular = odometry[-1].twist
    assert angular[2] == pytest.approx(0.03 / 0.051)
    assert linear[0] == pytest.approx(0.1 / 0.051 * math.sin(0.02), rel=1e-3)
    assert linear[1] == pytest.approx(0.1 / 0.051 * math.cos(0.02), rel=1e-3)


def test_twist_is_in_the_models_own_axes():
    plugin = make()
    odometry = collect(plugin.odometry)
    for x, y in ((0.0, 0.0), (0.1, 0.03)):
        place(plugin, Pose((x, y, 0.0), from_rpy(0.0, 0.0, 0.7)))
        run(plugin, 51)
    cos, sin = math.cos(0.7), math.sin(0.7)
    linear, angular = odometry[-1].twist
    assert linear == pytest.approx(
        ((0.1 * cos + 0.03 * sin) / 0.051, (0.03 * cos - 0.1 * sin) / 0.051, 0.0)
    )
    assert angular == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_odometry_of_a_too_fast_turn_is_the_command():
    plugin = make()
    odometry = collect(plugin.odometry)
    plugin.command(0.0, 100.0)
    run(plugin, 51)
    assert odometry[-1].twist.angular[2] == 100.0


def test_command_expires_after_its_timeout():
    plugin = make(cmdTimeout='0.1')
    plugin.command(0.5, 0.3, 0.2)
    run(plugin, 100)
    assert plugin.model.twist.angular == (0.0, 0.0, 0.3)
    run(plugin, 1)
    assert plugin.model.twist == ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


def test_command_without_timeout_holds_even_after_a_reset():
    plugin = make()
    plugin.command(0.5, 0.0)
    plugin.reset()
    run(plugin, 5000)
    assert plugin.model.twist.linear[0] == 0.5
