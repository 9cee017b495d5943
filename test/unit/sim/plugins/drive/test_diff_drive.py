"""The diff drive's timing, ramps, odometry and parameters, on the fake engine."""

import logging
import math

import pytest
from support.fake_drive import (
    PERIOD_STEPS,
    STEP,
    collect,
    make,
    place,
    rim_speeds,
    run,
    turn,
    wheel_of,
)

from rosbots_description.sim.core.errors import PluginError
from rosbots_description.sim.core.transforms import Pose, Twist, from_rpy
from rosbots_description.sim.runtime.outputs import JointStates


def test_the_first_update_comes_one_step_late_and_the_mean_rate_is_exact():
    plugin = make()
    clock, times = plugin.world.clock, []
    plugin.odometry.connect(lambda _: times.append(clock.steps))
    run(plugin, 100)
    assert times == [11, 21, 31, 41, 51, 61, 71, 81, 91]


@pytest.mark.parametrize(
    ('acceleration', 'turning', 'steps', 'speeds'),
    [
        pytest.param('0', 0.5, 11, (0.225, 0.775), id='the right one is faster in a left turn'),
        pytest.param('1', 0.0, 101, (10 * 0.011,) * 2, id='a ramp adds 11 ms of acceleration'),
        pytest.param('1', 0.0, 600, (0.5, 0.5), id='a ramp ends at the target'),
        pytest.param('1', 0.0, 20_000, (0.5, 0.5), id='a command holds without a timeout'),
    ],
)
def test_wheels_follow_the_command(acceleration, turning, steps, speeds):
    plugin = make(wheelAcceleration=acceleration)
    plugin.command(0.5, turning)
    run(plugin, steps)
    assert rim_speeds(plugin) == pytest.approx(speeds)


@pytest.mark.parametrize('wheel', ['left', 'right'])
def test_a_ramp_ends_when_either_wheel_turns_at_its_target_already(wheel):
    plugin = make()
    plugin.command(0.5, 0.0)
    turn(plugin, **{wheel: 0.5 / (plugin.wheel_diameter / 2.0)})
    run(plugin, PERIOD_STEPS + 1)
    assert rim_speeds(plugin) == pytest.approx((0.5, 0.5))


def test_ramp_of_both_wheels_ends_when_one_is_within_1_cm_per_s():
    plugin = make()
    plugin.command(0.55, 1.0)  # the left wheel stands, and its target is zero
    run(plugin, PERIOD_STEPS + 1)
    assert rim_speeds(plugin) == pytest.approx((0.0, 1.1))


def test_the_setpoint_is_not_synchronised_with_the_wheels():
    plugin = make()
    plugin.command(0.5, 0.0)
    run(plugin, PERIOD_STEPS * 5 + 1)
    turn(plugin, left=0.0, right=0.0)  # the wheels are blocked
    run(plugin, PERIOD_STEPS)
    assert rim_speeds(plugin) == pytest.approx((6 * 0.011,) * 2)


def test_the_torque_limit_is_wheel_torque():
    plugin = make(wheelTorque='2.5')
    assert plugin.model.joints['left'].effort == 2.5
    assert make(torque='20').model.joints['left'].effort == 5.0


def test_reset_clears_the_command_and_keeps_the_ramp():
    plugin = make()
    plugin.command(0.5, 0.0)
    run(plugin, 1000)
    plugin.reset()
    run(plugin, PERIOD_STEPS + 1)
    assert 0.0 < rim_speeds(plugin)[0] < 0.5
    run(plugin, 600)
    assert rim_speeds(plugin) == pytest.approx((0.0, 0.0))


def test_world_odometry_is_the_pose_of_the_model_and_its_twist_in_body_axes():
    plugin = make()
    odometry = collect(plugin.odometry)
    pose = Pose((1.0, 2.0, -0.12), from_rpy(0.0, 0.0, math.pi / 2))
    place(plugin, pose, Twist((0.0, 0.3, 0.1), (0.5, 0.6, 0.7)))
    run(plugin, PERIOD_STEPS + 1)
    assert odometry[0].pose == pose
    assert odometry[0].twist.linear == pytest.approx((0.3, 0.0, 0.0))
    assert odometry[0].twist.angular == (0.0, 0.0, 0.7)


def test_encoder_odometry_starts_at_zero_and_follows_the_wheels():
    plugin = make(odometrySource='encoder', wheelAcceleration='0')
    odometry = collect(plugin.odometry)
    plugin.command(0.5, 0.5)
    run(plugin, PERIOD_STEPS + 1)  # the wheels turn from here on
    run(plugin, 2000)
    pose, twist = odometry[-1]
    driven = (plugin.world.clock.steps - PERIOD_STEPS - 1) * STEP
    assert twist.linear == pytest.approx((0.5, 0.0, 0.0))
    assert twist.angular == pytest.approx((0.0, 0.0, 0.5))
    assert pose.position[0] == pytest.approx(math.sin(0.5 * driven), abs=2e-3)
    assert pose.position[1] == pytest.approx(1.0 - math.cos(0.5 * driven), abs=2e-3)
    assert pose.position[2] == 0.0


def test_encoder_odometry_restarts_at_zero_after_a_reset_at_any_time():
    plugin = make(odometrySource='encoder', wheelAcceleration='0')
    odometry = collect(plugin.odometry)
    plugin.command(0.5, 0.5)
    run(plugin, 100_000)
    plugin.reset()
    odometry.clear()
    run(plugin, PERIOD_STEPS + 1)
    assert math.hypot(*odometry[0].pose.position[:2]) <= 0.5 * 0.012
    assert abs(odometry[0].pose.orientation[2]) < 0.005


def test_encoder_speed_is_positive_also_when_driving_backwards():
    plugin = make(odometrySource='encoder', wheelAcceleration='0')
    odometry = collect(plugin.odometry)
    plugin.command(-0.5, 0.0)
    run(plugin, 100)
    assert odometry[-1].twist.linear[0] == pytest.approx(0.5)
    assert odometry[-1].pose.position[0] < 0.0


def test_joint_states_are_right_then_left():
    plugin = make(publishWheelJointState='true')
    states = collect(plugin.joint_states)
    plugin.model.joints['left'].set_position(1.5)
    run(plugin, PERIOD_STEPS + 1)
    assert states == [JointStates(('right', 'left'), (0.0, 1.5))]


def test_wheel_transforms_are_relative_to_the_model_whatever_the_parent():
    plugin = make(publishWheelTF='true')
    transforms = collect(plugin.wheel_transform)
    place(plugin, Pose((1.0, 0.0, 0.0)))
    run(plugin, PERIOD_STEPS + 1)
    assert [(t.parent, t.child) for t in transforms] == [
        ('base', 'left_link'),
        ('base', 'right_link'),
    ]
    assert transforms[0].pose.position == pytest.approx((0.1, 0.4, 0.2))


@pytest.mark.parametrize(
    ('tag', 'gone'),
    [
        ('publishTf', {'odometry', 'odometry_transform'}),
        ('publishOdomTF', {'odometry_transform'}),
        ('publishWheelTF', {'wheel_transform'}),
        ('publishWheelJointState', {'joint_states'}),
    ],
)
def test_disabled_output_does_not_exist(tag, gone):
    tags = dict.fromkeys(('publishWheelTF', 'publishWheelJointState'), 'true')
    assert make(**tags).outputs.keys() - make(**(tags | {tag: 'false'})).outputs.keys() == gone


def test_outputs_of_the_wheels_are_off_by_default():
    assert make().outputs.keys() == {'odometry', 'odometry_transform'}


def test_covariances_are_those_of_gazebo():
    plugin = make()
    assert plugin.pose_variances == (1e-5, 1e-5, 1e12, 1e12, 1e12, 1e-3)
    assert plugin.twist_variances == (0.0,) * 6


def test_state_of_the_model_is_read_once_per_update():
    plugin = make(publishWheelTF='true', publishWheelJointState='true')
    for output in plugin.outputs.values():
        collect(output)
    model, looks, state = plugin.model, [], plugin.model.state
    model.state = lambda: looks.append(1) or state()
    run(plugin, PERIOD_STEPS + 1)
    assert looks == [1]


def test_nothing_is_computed_without_readers():
    plugin = make(publishWheelTF='true', publishWheelJointState='true')
    plugin.model.state = plugin.model.links = None  # any access would fail
    run(plugin, 50)
    assert plugin.world.clock.steps == 50


def test_missing_tags_are_logged_with_upstreams_defaults(caplog):
    make(wheelSeparation=None, updateRate=None)
    for text in (
        'missing <rosDebugLevel> default is na',
        'missing <wheelSeparation> default is 0.34',
        'missing <updateRate> default is 100',
        'missing <wheelTorque> default is 5',
        'missing <publishOdomTF> default is true',
        'missing <odometrySource> default is 1',
    ):
        assert f'DiffDrive(ns = //): {text}' in caplog.messages


@pytest.mark.parametrize(('tag', 'namespace'), [(None, 'robot'), ('', 'robot'), ('/r1', '/r1')])
def test_the_namespace_is_the_models_name_unless_given(tag, namespace):
    assert make(robotNamespace=tag).namespace == namespace


def test_error_about_a_missing_joint_lists_the_joints():
    with pytest.raises(PluginError, match=r'hinge joint named wheel.*its joints: left, right'):
        make(leftJoint='wheel')


@pytest.mark.parametrize('text', ['wide', 'nan', '0', '-1'])
def test_invalid_separation_is_rejected(text):
    with pytest.raises(PluginError, match='wheelSeparation'):
        make(wheelSeparation=text)


def test_invalid_boolean_gives_the_default_with_a_warning(caplog):
    assert make(publishOdomTF='maybe').outputs['odometry_transform']
    assert "<publishOdomTF> is 'maybe'" in caplog.text


def test_unknown_tags_are_reported_once(caplog):
    make(torque='20', legacyMode='false', alwaysOn='true')
    (line,) = [text for text in caplog.messages if 'not read' in text]
    assert '<torque>, <legacyMode>' in line


def test_tags_that_contradict_the_wheels_give_one_warning(caplog):
    make(wheel_collisions=wheel_of(0.23))
    (record,) = [one for one in caplog.records if 'contradict' in one.getMessage()]
    assert 'contradict the collision geometry (0.46 m and 0.8 m)' in record.getMessage()
    assert '0.88 of the commanded speed' in record.getMessage()
    assert 'or at 0.87 and 1.20 if it drags a caster' in record.getMessage()
    assert record.levelno == logging.WARNING


@pytest.mark.parametrize(
    'tags',
    [
        {'wheelDiameter': '0.46', 'wheelSeparation': '1.0'},
        {'wheelDiameter': '0.56', 'wheelSeparation': '0.8'},
        {'wheelDiameter': '0.552', 'wheelSeparation': '0.96'},  # 1.2 times too large, both
    ],
)
def test_either_tag_that_contradicts_the_wheels_gives_a_warning(caplog, tags):
    make(wheel_collisions=wheel_of(0.23), **tags)
    assert 'contradict' in caplog.text


def test_tags_that_fit_the_wheels_give_no_warning(caplog):
    make(wheel_collisions=wheel_of(0.23), wheelDiameter='0.46', wheelSeparation='0.8')
    assert 'contradict' not in caplog.text


def test_left_joint_on_the_right_side_gives_one_warning_with_the_cure(caplog):
    make(wheel_collisions=wheel_of(0.26), leftJoint='right', rightJoint='left')
    (line,) = [text for text in caplog.messages if 'this robot will' in text]
    assert "turn right when asked to turn left, for 'right' is on the right side" in line
    assert line.endswith('swap <leftJoint> and <rightJoint>')


def test_wheels_on_their_sides_give_no_warning(caplog):
    make(wheel_collisions=wheel_of(0.26))
    assert 'this robot will' not in caplog.text
