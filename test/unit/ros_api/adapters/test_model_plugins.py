"""Topics of state and force plugins: names, types, frames, covariances."""

import pytest
from genpy import Duration, Time
from geometry_msgs.msg import Vector3, Wrench
from nav_msgs.msg import Odometry
from std_msgs.msg import Header
from support.fake_drive import fake_model, make_drive, place, run
from support.wire import Wire
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from rosbots_description.ros_api.adapters import adapter as adapter_module
from rosbots_description.ros_api.adapters.force import pose_between, read_wrench
from rosbots_description.ros_api.adapters.state import read_trajectory
from rosbots_description.sim.core.transforms import Pose, Twist, from_rpy
from rosbots_description.sim.plugins.state.joint_state_publisher import JointStatePublisher
from rosbots_description.sim.plugins.state.p3d import P3D

NAN = float('nan')


@pytest.fixture
def wire(monkeypatch):
    made = Wire(monkeypatch)
    monkeypatch.setattr(adapter_module, 'find_tf_prefix', lambda _: 'r1')
    return made


def p3d(**tags):
    return make_drive(P3D, fake_model(), bodyName='base', topicName='gt', **tags)


def test_p3d_has_its_frames_and_the_variance_of_its_noise_in_both_covariances(wire):
    plugin = p3d(robotNamespace='a', gaussianNoise='0.01', frameName='left_link')
    wire.join(plugin)
    topic = wire.publishers['/a/gt']
    assert topic.options == {'queue_size': 1, 'latch': False}
    topic.read()
    run(plugin, 2)
    message = topic.sent[-1]
    assert isinstance(message, Odometry)
    assert (message.header.frame_id, message.child_frame_id) == ('r1/left_link', 'base')
    assert message.header.stamp.to_nsec() == 2_000_000
    expected = [1e-4 if i % 7 == 0 else 0.0 for i in range(36)]
    for covariance in (message.pose.covariance, message.twist.covariance):
        assert list(covariance) == pytest.approx(expected)


def test_p3d_with_an_unknown_frame_publishes_nothing(wire):
    plugin = p3d(frameName='odom')
    wire.join(plugin)
    wire.publishers['/gt'].read()
    run(plugin, 100)
    assert not wire.publishers['/gt'].sent


def test_p3d_publishes_pose_and_twist_in_world_axes(wire):
    plugin = p3d(frameName='/world')
    wire.join(plugin)
    wire.publishers['/gt'].read()
    place(plugin, Pose((1.0, 2.0, 3.0), from_rpy(0.0, 0.0, 1.0)), Twist((0.1, 0.2, 0.3), (4, 5, 6)))
    run(plugin, 1)
    message = wire.publishers['/gt'].sent[-1]
    assert message.header.frame_id == 'world'
    twist = message.twist.twist
    assert (twist.linear.x, twist.linear.y, twist.angular.z) == (0.1, 0.2, 6.0)
    assert (message.pose.pose.position.z, message.pose.pose.orientation.x) == (3.0, 0.0)


@pytest.mark.parametrize('joints', ['right, left', ''])
def test_joint_states_have_no_frame_and_no_efforts(wire, joints):
    plugin = make_drive(JointStatePublisher, fake_model(), jointName=joints, updateRate='20')
    wire.join(plugin)
    topic = wire.publishers['/robot/joint_states']
    assert topic.options == {'queue_size': 1000, 'latch': False}
    topic.read()
    run(plugin, 51)
    (message,) = topic.sent
    assert message.header.frame_id == ''
    assert message.name == [name.strip() for name in joints.split(',') if name]
    assert len(message.position) == len(message.velocity) == len(message.name)
    assert list(message.effort) == []


def test_trajectory_is_converted_with_times_in_nanoseconds():
    message = JointTrajectory(
        Header(stamp=Time(3, 5), frame_id='a'),
        ['j'],
        [JointTrajectoryPoint(positions=[0.5], time_from_start=Duration(1, 7))],
    )
    assert read_trajectory(message) == ('a', 3_000_000_005, ['j'], [([0.5], 1_000_000_007)])
    message.points[0].positions = [NAN]
    with pytest.raises(ValueError, match='positions of point 0 nan; numbers must be finite'):
        read_trajectory(message)


def test_wrench_is_converted_to_two_finite_vectors():
    message = Wrench(Vector3(1.0, 2.0, 3.0), Vector3(4.0, 5.0, 6.0))
    assert read_wrench(message) == ((1.0, 2.0, 3.0), (4.0, 5.0, 6.0))
    message.torque.y = NAN
    with pytest.raises(ValueError, match=r'torque\.y nan'):
        read_wrench(message)


STEP = Pose((1.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ('edges', 'x'),
    [
        ({}, None),
        ({'goal': ('world', STEP)}, 1.0),
        ({'goal': ('a', STEP), 'a': ('world', STEP)}, 2.0),
        ({'goal': ('map', STEP), 'world': ('map', STEP)}, 0.0),
        ({'world': ('goal', STEP)}, -1.0),
        ({'goal': ('odom', STEP)}, None),
        ({'goal': ('a', STEP), 'a': ('goal', STEP)}, None),
    ],
)
def test_transform_is_looked_up_along_the_tf_tree(edges, x):
    pose = pose_between('world', 'goal', edges)
    assert (pose and pose.position[0]) == x
