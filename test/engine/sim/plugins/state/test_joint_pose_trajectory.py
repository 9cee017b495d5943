"""Trajectories of joint positions: as recorded in Gazebo, with physics paused meanwhile."""

import math

import pytest
from support import empty_world, urdf_spec
from support.recorded import DATA, load
from support.scenes import box, link

from rosbots_description.sim.core.transforms import Pose, Twist
from rosbots_description.sim.formats.urdf.urdf import load_urdf

HALF = 500_000_000  # [ns]
BEGAN = 30.417  # [s] start of the trajectory, estimated: it was not recorded
PLUGIN = '<gazebo><plugin name="jpt" filename="libgazebo_ros_joint_pose_trajectory.so"/></gazebo>'
ARM = (
    box('base', (1.0, 1.0, 1.0), 10.0)
    + link('rod', '<sphere radius="0.1"/>', 1.0, (0.1, 0.1, 0.1))
    + '<joint name="turn" type="continuous"><parent link="base"/><child link="rod"/>'
    '<origin xyz="0 0 2"/><axis xyz="0 0 1"/></joint>' + PLUGIN
)


@pytest.fixture
def arm(world):
    """Return a base with a rod on a joint, in free space."""
    return world.spawn(urdf_spec(ARM, 'arm'), 'arm', Pose((0.0, 0.0, 5.0)))


def test_arm_moves_and_falls_as_recorded():
    text = (DATA / 'robots' / 'arm_ft.urdf').read_text(encoding='utf-8')
    with empty_world() as world:
        model = world.spawn(load_urdf(text, 'arm')[0], 'arm', Pose())
        shoulder, elbow = (model.joints[name] for name in ('shoulder', 'elbow'))
        shoulder.set_position(math.pi)
        points = [((0.3 * k, -0.2 * k), HALF) for k in range(5)]
        model.plugin('jpt').play('world', 0, ['shoulder', 'elbow'], points)
        compared = 0
        for stamp, positions, velocities in load('model_plugins')['trajectory']:
            steps = round((stamp - BEGAN) * 1000)
            if steps <= 0:
                continue
            world.run(steps - world.clock.steps)
            states = shoulder.state(), elbow.state()
            assert [s[0] for s in states] == pytest.approx(positions, abs=2e-3)
            assert [s[1] for s in states] == pytest.approx(velocities, abs=0.01)
            compared += 1
        assert compared > 30


def test_each_point_holds_until_its_time(world, arm):
    joint, found = arm.joints['turn'], {}
    arm.plugin('jpt').play('world', 0, ['turn'], [((1.0,), 3_000_000), ((2.0,), 0), ((3.0,), 0)])
    for step in range(1, 7):
        world.run(1)
        found[step] = joint.position
    assert found == {1: 1.0, 2: 1.0, 3: 2.0, 4: 3.0, 5: pytest.approx(3.0), 6: pytest.approx(3.0)}


def test_physics_is_paused_during_a_trajectory_and_continues_after_it(world, arm):
    other = world.spawn(urdf_spec(box('box', (1.0, 1.0, 1.0), 1.0)), 'box', Pose((9.0, 0.0, 5.0)))
    world.run(100)
    arm.set_twist(Twist((0.1, 0.0, 0.0), (0.0, 0.0, 0.2)))
    arm.joints['turn'].set_position(0.0, 0.7)
    before, falling = arm.twist, other.state()
    arm.plugin('jpt').play('map', 0, ['turn'], [((1.0,), HALF)])
    world.run(499)
    assert world.clock.steps == 599
    assert arm.twist == before
    assert arm.joints['turn'].velocity == 0.7
    assert other.state() == falling
    world.run(1)  # the last point ends in the step of its time
    assert other.state() != falling
    assert arm.joints['turn'].velocity == pytest.approx(0.7, abs=1e-3)


def test_forces_during_a_trajectory_have_no_effect(world, arm):
    other = world.spawn(urdf_spec(box('box', (1.0, 1.0, 1.0), 1.0)), 'box', Pose((9.0, 0.0, 5.0)))
    world.external_forces.add(
        other.link('box'),
        lambda: other.link('box').apply_wrench((1.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
        0,
        -1,
    )
    arm.plugin('jpt').play('world', 0, ['turn'], [((1.0,), HALF)])
    world.run(501)
    assert other.twist.linear[0] == pytest.approx(1e-3)


def test_reference_link_of_a_trajectory_does_not_move(world, arm):
    rod = arm.link('rod').pose
    arm.plugin('jpt').play('arm::rod', 0, ['turn'], [((1.0,), HALF)])
    world.run(1)
    assert arm.joints['turn'].position == 1.0
    assert arm.link('rod').pose.position == pytest.approx(rod.position)
    assert arm.link('rod').pose.orientation == pytest.approx(rod.orientation)
    assert arm.pose.orientation != pytest.approx(rod.orientation)


def test_trajectory_moves_the_model_of_its_reference_link(world, arm):
    second = world.spawn(urdf_spec(ARM, 'arm'), 'second', Pose((0.0, 9.0, 5.0)))
    arm.plugin('jpt').play('second::base', 0, ['turn'], [((1.0,), HALF)])
    world.run(1)
    assert (arm.joints['turn'].position, second.joints['turn'].position) == (0.0, 1.0)


def test_positions_that_are_not_finite_are_rejected(arm):
    with pytest.raises(ValueError, match='takes finite positions'):
        arm.plugin('jpt').play('world', 0, ['turn'], [((math.nan,), HALF)])


@pytest.mark.parametrize('frame', ['', 'nope', 'arm'])
def test_unknown_reference_link_is_an_error_without_a_pause(world, arm, caplog, frame):
    arm.plugin('jpt').play(frame, 0, ['turn'], [((1.0,), HALF)])
    assert caplog.messages == [
        f'ros_joint_trajectory plugin needs a reference link [{frame}] as frame_id, aborting.'
    ]
    world.run(2)
    assert arm.twist.linear[2] < 0.0
    assert arm.joints['turn'].position == 0.0


def test_points_of_wrong_length_are_skipped_and_unknown_joints_ignored(world, arm, caplog):
    points = [((1.0,), 1_000_000), ((1.5, 9.0), 0)]
    arm.plugin('jpt').play('world', 0, ['turn', 'nope'], points)
    assert caplog.messages == [
        "joint_pose_trajectory: model 'arm' has no joint nope; its joints: turn"
    ]
    world.run(2)
    assert caplog.messages[1:] == [
        'point[0] in JointTrajectory has different number of joint names[2] and positions[1].'
    ]
    assert arm.joints['turn'].position == 1.5


def test_trajectory_with_a_later_start_waits_with_a_message(world, arm, caplog):
    arm.plugin('jpt').play('world', 5_000_000, ['turn'], [((1.0,), 0)])
    assert 'begins at 0.005 s; until it has ended nothing moves' in caplog.text
    world.run(4)
    assert arm.joints['turn'].position == 0.0
    world.run(1)
    assert arm.joints['turn'].position == 1.0
    assert arm.twist.linear[2] == 0.0


@pytest.mark.parametrize('end', ['another', 'delete', 'reset', 'delete the moved model'])
def test_physics_continues_when_a_trajectory_is_replaced_or_its_model_deleted(world, arm, end):
    other = world.spawn(urdf_spec(box('box', (1.0, 1.0, 1.0), 1.0)), 'box', Pose((9.0, 0.0, 5.0)))
    plugin = arm.plugin('jpt')
    plugin.play('world', 0, ['turn'], [((1.0,), HALF)])
    world.run(10)
    if end == 'another':
        plugin.play('world', 0, ['turn'], [])
        world.run(1)
    elif end == 'delete':
        world.delete('arm')
    elif end == 'delete the moved model':
        world.spawn(urdf_spec(ARM, 'arm'), 'second', Pose((0.0, 9.0, 5.0)))
        plugin.play('second::rod', 0, ['turn'], [((1.0,), 1_000_000)] * 9)
        world.run(2)
        world.delete('second')
    else:
        world.reset_simulation()
    world.run(10)
    assert other.twist.linear[2] < 0.0
