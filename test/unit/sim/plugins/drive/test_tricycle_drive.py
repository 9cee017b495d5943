"""The tricycle drive's tags, ramps, steering and odometry, on the fake engine."""

import math

import pytest
from support.fake_drive import collect, fake_model, make_drive, run, turn

from rosbots_description.sim.core.errors import PluginError
from rosbots_description.sim.plugins.drive.tricycle_drive import TricycleDrive

JOINTS = ('front_steering_joint', 'front_wheel_joint', 'left_wheel_joint', 'right_wheel_joint')


def make(joints=JOINTS, **tags):
    return make_drive(TricycleDrive, fake_model(names=joints), **tags)


def test_all_tags_have_upstreams_defaults(caplog):
    values = make(wheelAcceleration='2.5').params.values
    assert (values['actuatedWheelDiameter'], values['encoderWheelDiameter']) == (0.15, 0.15)
    assert (values['encoderWheelSeparation'], values['wheelTorque']) == (0.5, 5.0)
    assert (values['wheelAcceleration'], values['wheelDeceleration']) == (2.5, 2.5)
    assert (values['wheelSpeedTolerance'], values['steeringAngleTolerance']) == (0.01, 0.01)
    assert values['steeringSpeed'] == 0.0
    assert (values['odometrySource'], values['robotBaseFrame']) == ('world', 'base_link')
    assert (values['publishWheelTF'], values['publishWheelJointState']) == (False, False)
    assert 'TricycleDrive(ns = robot/): missing <wheelTorque> default is 5' in caplog.messages


def test_odometry_and_its_transform_are_always_output():
    assert make().outputs.keys() == {'odometry', 'odometry_transform'}


@pytest.mark.parametrize('joint', JOINTS)
def test_missing_joint_is_an_error(joint):
    with pytest.raises(PluginError, match=joint):
        make([name for name in JOINTS if name != joint])


def test_duplicate_joint_is_an_error():
    with pytest.raises(PluginError, match='two of its joints are one'):
        make(steeringJoint='front_wheel_joint')


def test_forward_speed_is_the_rim_speed_of_the_driven_wheel():
    plugin = make(actuatedWheelDiameter='0.5')
    plugin.command(1.0, 0.0)
    run(plugin, 11)
    assert plugin.model.joints['front_wheel_joint'].velocity == pytest.approx(4.0)


def test_reset_of_the_world_keeps_command_and_odometry():
    plugin = make(odometrySource='encoder')
    plugin.command(1.0, 0.2)
    turn(plugin, left_wheel_joint=0.5, right_wheel_joint=0.5)
    run(plugin, 100)
    place = plugin.encoders.place
    plugin.reset()
    assert (plugin.target, plugin.encoders.place) == ((1.0, 0.0, 0.2), place)
    assert place[0] > 0.0
    plugin.restart()
    assert (plugin.target, plugin.encoders.place) == ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


def test_acceleration_and_deceleration_are_swapped_as_upstream():
    plugin = make(wheelAcceleration='1', wheelDeceleration='5', actuatedWheelDiameter='0.2')
    wheel = plugin.model.joints['front_wheel_joint']
    plugin.command(1.0, 0.0)
    run(plugin, 11)
    assert wheel.velocity == pytest.approx(5 * 0.011)
    turn(plugin, front_wheel_joint=9.0)
    plugin.command(0.0, 0.0)
    run(plugin, 10)
    assert wheel.velocity == pytest.approx(9.0 - 1 * 0.011)


def test_wheel_within_the_tolerance_keeps_its_speed():
    plugin = make(wheelAcceleration='1', wheelSpeedTolerance='0.5', actuatedWheelDiameter='2')
    turn(plugin, front_wheel_joint=0.6)
    plugin.command(1.0, 0.0)
    run(plugin, 11)
    assert plugin.model.joints['front_wheel_joint'].velocity == 0.6


@pytest.mark.parametrize(('angle', 'speed'), [(0.3, 0.4), (-0.3, -0.4), (0.01, 0.0)])
@pytest.mark.parametrize('forward', [1.0, -1.0, 0.0])
def test_steering_turns_towards_the_angle_at_its_speed(angle, speed, forward):
    plugin = make(steeringSpeed='0.4', steeringAngleTolerance='0.02')
    plugin.command(forward, angle)
    run(plugin, 11)
    assert plugin.model.joints['front_steering_joint'].velocity == speed


def test_steering_without_a_speed_limit_is_immediate_and_within_90_degrees():
    plugin = make()
    plugin.command(0.0, 3.0)
    run(plugin, 11)
    assert plugin.model.joints['front_steering_joint'].position == pytest.approx(math.pi / 2)


def test_encoder_odometry_has_the_yaw_sign_and_twist_frame_of_upstream():
    plugin = make(odometrySource='encoder', encoderWheelDiameter='0.2')
    odometry = collect(plugin.odometry)
    turn(plugin, left_wheel_joint=-5.0, right_wheel_joint=-3.0)
    run(plugin, 1001)
    pose, twist = odometry[-1]
    assert twist.angular == pytest.approx((0.0, 0.0, -(5.0 - 3.0) * 0.1 / 0.5), rel=1e-6)
    assert twist.linear[2] == 0.0
    yaw = 2.0 * math.asin(pose.orientation[2])
    assert yaw == pytest.approx(-0.4, rel=2e-2)
    assert twist.linear[:2] == pytest.approx((-0.4 * math.cos(yaw), -0.4 * math.sin(yaw)), rel=2e-2)


def test_joint_states_are_steering_driven_left_right_with_velocities_and_efforts():
    plugin = make(publishWheelJointState='true')
    states = collect(plugin.joint_states)
    turn(plugin, left_wheel_joint=2.0)
    run(plugin, 11)
    assert states[0].names == JOINTS
    assert states[0].velocities == (0.0, 0.0, 2.0, 0.0)
    assert states[0].efforts == (0.0,) * 4


def test_wheel_transforms_are_named_after_joints():
    plugin = make(publishWheelTF='true')
    edges = collect(plugin.wheel_transform)
    run(plugin, 11)
    assert [edge.child for edge in edges] == list(JOINTS)
