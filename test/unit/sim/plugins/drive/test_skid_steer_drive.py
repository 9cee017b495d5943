"""The skid steer drive's tags, timing, wheels and odometry, on the fake engine."""

import pytest
from support.fake_drive import collect, fake_model, make_drive, place, run

from rosbots_description.sim.core.errors import PluginError
from rosbots_description.sim.core.transforms import Pose, Twist, from_rpy
from rosbots_description.sim.plugins.drive.skid_steer_drive import SkidSteerDrive

JOINTS = ('left_front_joint', 'right_front_joint', 'left_rear_joint', 'right_rear_joint')


def make(joints=JOINTS, **tags):
    return make_drive(SkidSteerDrive, fake_model(names=joints), **tags)


def speeds(plugin):
    return [joint.velocity for joint in plugin.model.joints.values()]


def test_all_tags_have_upstreams_defaults_and_its_warnings(caplog):
    plugin = make()
    assert tuple(wheel.name for wheel in plugin.wheels) == JOINTS
    assert (plugin.wheel_separation, plugin.wheel_diameter, plugin.torque) == (0.4, 0.15, 5.0)
    values = plugin.params.values
    assert (values['commandTopic'], values['odometryTopic']) == ('cmd_vel', 'odom')
    assert (values['odometryFrame'], values['robotBaseFrame']) == ('odom', 'base_footprint')
    assert (values['updateRate'], values['broadcastTF'], plugin.namespace) == (100.0, False, '')
    assert plugin.pose_variances == plugin.twist_variances == (1e-4, 1e-4, 1e12, 1e12, 1e12, 0.01)
    prefix = 'GazeboRosSkidSteerDrive Plugin (ns = /) missing '
    assert f'{prefix}<commandTopic>, defaults to "cmd_vel"' in caplog.messages
    assert f'{prefix}<covariance_yaw>, defaults to 0.010000' in caplog.messages
    assert f'{prefix}<broadcastTF>, defaults to false' in caplog.messages


def test_topic_tag_of_other_plugins_is_reported_as_unknown(caplog):
    make(topicName='cmd_vel')
    assert 'not read by this plugin: <topicName>' in caplog.text


@pytest.mark.parametrize('joint', JOINTS)
def test_missing_wheel_is_an_error(joint):
    with pytest.raises(PluginError, match=joint):
        make([name for name in JOINTS if name != joint])


@pytest.mark.parametrize(
    ('tag', 'value'),
    [
        ('wheelDiameter', '0'),
        ('wheelSeparation', '-1'),
        ('updateRate', '1e-9'),
        ('torque', 'much'),
    ],
)
def test_invalid_tag_is_rejected(tag, value):
    with pytest.raises(PluginError, match=tag):
        make(**{tag: value})


def test_front_and_rear_wheels_get_equal_speeds_at_once():
    plugin = make(wheelSeparation='0.5', wheelDiameter='0.2', torque='7')
    plugin.command(1.0, 2.0)
    run(plugin, 10)
    assert speeds(plugin) == [0.0] * 4
    run(plugin, 1)
    assert speeds(plugin) == pytest.approx([5.0, 15.0] * 2)
    assert {joint.effort for joint in plugin.model.joints.values()} == {7.0}


def test_odometry_is_the_true_pose_one_step_late():
    plugin = make()
    odometry, edges = collect(plugin.odometry), collect(plugin.odometry_transform)
    there = Pose((1.0, 2.0, 3.0), from_rpy(0.0, 0.0, 1.5707963267948966))
    place(plugin, there, Twist((0.0, 0.5, 0.1), (0.0, 0.0, 0.2)))
    run(plugin, 31)
    assert len(odometry) == len(edges) == 3
    pose, twist = odometry[-1]
    assert pose == Pose((1.0, 2.0, 0.0), there.orientation)  # the transform is not projected
    assert edges[-1] == ('odom', 'base_footprint', there)
    assert twist.linear == pytest.approx((0.5, 0.0, 0.0))


def test_reset_keeps_the_command():
    plugin = make()
    plugin.command(0.3, 0.0)
    plugin.reset()
    run(plugin, 11)
    assert speeds(plugin) == pytest.approx([4.0] * 4)


def test_a_restart_stops_the_wheels():
    plugin = make()
    plugin.command(0.3, 0.0)
    run(plugin, 11)
    plugin.restart()
    assert speeds(plugin) == [0.0] * 4
