"""P3D against what was recorded in Gazebo, and the true pose of links that were reduced."""

import math
from contextlib import closing

import pytest
from support import urdf_spec
from support.fake_drive import collect
from support.recorded import DATA, load
from support.scenes import box

from rosbots_description.sim.core.transforms import Pose, Twist, compose, from_rpy
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.runtime.world import World

NEAR = 0.01  # [m, m/s, rad/s]: effect of gravity and of some ms of motion


def recorded(name):
    """Return frames, pose and twist of the first recorded message of a plugin."""
    stored = load('model_plugins')['p3d'][name]
    position, orientation, linear, angular = (tuple(part) for part in stored['row'][1:])
    return stored['frames'], Pose(position, orientation), Twist(linear, angular)


@pytest.fixture
def skid4():
    """Yield the recorded robot with its motion at 5.797 s."""
    text = (DATA / 'robots' / 'skid4_p3d.urdf').read_text(encoding='utf-8')
    with closing(World()) as world:
        model = world.spawn(load_urdf(text, 'skid4', robot_namespace='/')[0], 'skid4', Pose())
        model.world = world
        model.plugin('skid_steer_drive').command(0.4, 0.5)
        world.run(50)  # the first periods are over
        _, pose, twist = recorded('gt')
        states = load('model_plugins')['joint_states']
        stamp, positions, velocities = states['row']
        model.set_pose(pose)
        model.set_twist(twist)
        for name, position, velocity in zip(states['names'], positions, velocities, strict=True):
            joint = model.joints[name]
            joint.set_position(position - (stamp - 5.797) * velocity, velocity)
            joint.set_motor(velocity, 20.0)
        yield model


def first_reading(model, plugin):
    readings = collect(model.plugin(plugin).odometry)
    model.world.run(1)
    return readings[0]


def test_twist_of_the_body_is_in_world_axes(skid4):
    _, pose, twist = recorded('gt')
    found = first_reading(skid4, 'p3d_a')
    assert found.pose.position == pytest.approx(pose.position, abs=NEAR)
    assert found.pose.orientation == pytest.approx(pose.orientation, abs=NEAR)
    assert found.twist.linear == pytest.approx(twist.linear, abs=2 * NEAR)
    assert found.twist.angular == pytest.approx(twist.angular, abs=5 * NEAR)


def test_wheel_in_the_frame_of_the_body_is_as_recorded(skid4):
    (_, child), pose, twist = recorded('gt_wheel')
    found = first_reading(skid4, 'p3d_wheel')
    assert skid4.plugin('p3d_wheel').body == child
    assert found.pose.position == pytest.approx(pose.position, abs=1e-4)
    alike = abs(sum(a * b for a, b in zip(found.pose.orientation, pose.orientation, strict=True)))
    assert 2.0 * math.acos(alike) < 2 * NEAR  # [rad] between both
    assert found.twist.linear == pytest.approx(twist.linear, abs=NEAR)
    assert found.twist.angular == pytest.approx(twist.angular, abs=5 * NEAR)


def test_reduced_link_has_its_true_pose_in_the_frame_named_after_its_parent(skid4):
    (_, child), pose, _ = recorded('gt_lumped')
    found = first_reading(skid4, 'p3d_lumped')
    assert skid4.plugin('p3d_lumped').body == child == 'base_footprint'
    assert found.pose.orientation == pytest.approx(pose.orientation, abs=NEAR)
    # Gazebo gives -0.131: it subtracts the height of base_link, 0.13 m.
    assert found.pose.position[2] == pytest.approx(pose.position[2] + 2 * 0.13, abs=1e-4)


def test_in_a_strict_world_a_reduced_link_is_where_gazebo_tells_it(world):
    text = (DATA / 'robots' / 'skid4_p3d.urdf').read_text(encoding='utf-8')
    world.strict = True
    at = recorded('gt')[1]
    model = world.spawn(load_urdf(text, 'skid4')[0], 'skid4', at)
    plugin = model.plugin('p3d_lumped')
    readings = collect(plugin.odometry)
    plugin.report()
    assert plugin.body == 'base_footprint'
    height = recorded('gt_lumped')[1].position[2] - at.position[2]  # -0.13 m, where +0.13 is true
    assert readings[0].pose.position == pytest.approx(
        (*at.position[:2], at.position[2] + height), abs=1e-6
    )
    assert readings[0].pose.orientation == pytest.approx(at.orientation, abs=1e-6)


P3D = (
    '<gazebo><plugin name="{name}" filename="libgazebo_ros_p3d.so"><topicName>t</topicName>'
    '<bodyName>{body}</bodyName><frameName>{frame}</frameName></plugin></gazebo>'
)
PLACE = Pose((0.3, -0.2, 0.5), from_rpy(0.4, 0.2, -1.0))  # of the mast in the base


def test_reduced_link_on_a_rotating_body_has_its_true_pose_and_twist(world):
    mast = (
        '<joint name="m" type="fixed"><parent link="base"/><child link="mast"/>'
        '<origin xyz="0.3 -0.2 0.5" rpy="0.4 0.2 -1.0"/></joint>'
    )
    plugins = P3D.format(name='mast', body='mast', frame='world') + P3D.format(
        name='base', body='base', frame='mast'
    )
    spec = urdf_spec(box('base', (1.0, 1.0, 1.0), 1.0) + '<link name="mast"/>' + mast + plugins)
    at = Pose((1.0, 2.0, 3.0), from_rpy(0.0, 0.5, math.pi / 3))
    model = world.spawn(spec, 'thing', at)
    model.world = world
    model.set_twist(Twist((0.0, 0.0, 0.0), (0.0, 0.0, 2.0)))
    mast, base = collect(model.plugin('mast').odometry), collect(model.plugin('base').odometry)
    world.run(1)
    true = compose(model.pose, PLACE)
    assert mast[0].pose.position == pytest.approx(true.position)
    assert mast[0].pose.orientation == pytest.approx(true.orientation)
    x, y, _ = (a - b for a, b in zip(true.position, model.pose.position, strict=True))
    assert mast[0].twist.linear[:2] == pytest.approx((-2.0 * y, 2.0 * x), abs=1e-3)
    back = compose(Pose(), base[0].pose)
    assert compose(Pose(true.position, true.orientation), Pose(back.position)).position == (
        pytest.approx(model.pose.position)
    )
