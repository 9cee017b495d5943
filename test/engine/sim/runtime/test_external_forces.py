"""Forces and torques give the accelerations of rigid-body mechanics, for their duration."""

import math
from dataclasses import replace

import pytest
from support import SPAWN_POSE, empty_world, robot_spec, urdf_spec
from support.scenes import link

from rosbots_description.sim.core.transforms import IDENTITY, ZERO, Pose, Twist, from_rpy
from rosbots_description.sim.description.model_spec import Inertial, JointSpec, LinkSpec, ModelSpec

SECOND_NS = 10**9
MOMENTS = (0.1, 0.2, 0.25)  # [kg m^2]
HIGH = Pose((0.0, 0.0, 500.0))


def free_body(com=IDENTITY):
    link = LinkSpec('link', inertial=Inertial(1.0, com, *MOMENTS), gravity=False)
    return ModelSpec('body', (link,))


@pytest.fixture
def body(world):
    """Return a free body of 1 kg, high above the ground."""
    return world.spawn(free_body(), 'body', HIGH)


def push(world, model, force, torque=ZERO, start=0.0, duration=1.0):
    """Push a model of one link from `start` on for `duration` [s]."""
    link = model.links['link']
    world.external_forces.add(
        link,
        lambda: link.apply_wrench(force, torque),
        round(start * SECOND_NS),
        round(duration * SECOND_NS),
    )


def test_a_force_acts_at_the_centre_of_mass(world):
    model = world.spawn(free_body(com=Pose((0.3, 0.2, 0.1))), 'body', HIGH)
    push(world, model, (0.0, 2.0, 0.0))
    world.run(1500)
    assert model.twist.linear == pytest.approx((0.0, 2.0, 0.0), abs=0.01)
    assert model.twist.angular == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)


def test_force_at_a_point_has_a_lever_arm(world, body):
    x, y, z = HIGH.position
    world.engine.apply_wrench(body.body, 'link', (0.0, 5.0, 0.0), (0.0, 0.0, 0.0), (x + 2.0, y, z))
    world.run(1)
    assert body.twist.linear == pytest.approx((0.0, 0.005, 0.0), abs=1e-6)
    assert body.twist.angular == pytest.approx((0.0, 0.0, 0.01 / MOMENTS[2]), rel=1e-3)


@pytest.mark.parametrize('axis', [0, 1, 2])
def test_a_torque_about_a_principal_axis_gives_the_analytic_rate(world, body, axis):
    torque = tuple(0.1 if i == axis else 0.0 for i in range(3))
    push(world, body, ZERO, torque)
    world.run(1500)
    assert body.twist.angular[axis] == pytest.approx(0.1 / MOMENTS[axis], rel=0.01)


def test_torque_and_force_are_in_world_axes_whatever_the_bodys_attitude(world):
    pose = Pose(HIGH.position, from_rpy(0.0, math.pi / 2, 0.0))  # its x axis points down
    model = world.spawn(free_body(), 'body', pose)
    push(world, model, (1.0, 0.0, 0.0), (0.0, 0.0, 0.1))
    world.run(1100)
    assert model.twist.linear[0] == pytest.approx(1.0, abs=0.005)
    assert model.twist.angular[2] == pytest.approx(0.1 / MOMENTS[0], rel=0.01)


@pytest.mark.parametrize(
    ('start', 'duration', 'speed'),
    [(0.0, 0.0, 0.0), (0.5, 0.2, 0.2), (0.9, 5.0, 0.1), (0.0, -1.0, 1.0), (5.0, 1.0, 0.0)],
)
def test_force_acts_from_its_start_for_its_duration(world, body, start, duration, speed):
    push(world, body, (1.0, 0.0, 0.0), ZERO, start, duration)
    world.run(1000)
    assert body.twist.linear[0] == pytest.approx(speed, abs=0.0021)


def test_force_keeps_its_duration_when_the_step_size_changes(world, body):
    push(world, body, (1.0, 0.0, 0.0), start=1.0)
    world.run(500)
    world.set_physics(replace(world.physics, step_size=0.002))
    world.run(240)
    assert body.twist.linear[0] == 0.0
    world.run(600)
    assert body.twist.linear[0] == pytest.approx(1.0, abs=0.005)


@pytest.mark.parametrize('together', [3, 8, 40])
def test_combined_steps_are_bit_identical_to_single_ones(together):
    """A force applied between two runs acts in the next step only."""
    seen = []
    for run in (1, together):
        with empty_world() as world:
            robot = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
            for _ in range(5):
                next(iter(robot.links.values())).apply_wrench((30.0, 0.0, 5.0), (0.0, 0.0, 1.0))
                robot.joint('wheel_left_joint').apply_effort(0.5)
                for _ in range(120 // run):
                    world.run(run)
            parts = [*robot.links.values(), *robot.joints.values()]
            seen.append([part.state() for part in parts])
    assert seen[0] == seen[1]


def test_combined_steps_of_a_damped_joint_are_identical_to_single_ones():
    bar = link('bar', '<box size="1 0.1 0.1"/>', 1.0, (0.01, 0.1, 0.1))
    spec = urdf_spec(
        f'<link name="world"/>{bar}<joint name="j" type="continuous"><parent link="world"/>'
        f'<child link="bar"/><origin xyz="0 0 2"/><axis xyz="0 1 0"/>'
        '<dynamics damping="0.7"/></joint>'
    )
    seen = []
    for run in (1, 3, 93):
        with empty_world() as world:
            joint = world.spawn(spec, 'bar', Pose()).joints['j']
            joint.apply_effort(500.0)
            for _ in range(93 // run):
                world.run(run)
            seen.append(joint.state())
    assert 1.0 < seen[0][1] < 5.0  # [rad/s]: a motion that is damped
    assert seen == [seen[0]] * 3


def test_cleared_force_ends(world, body):
    push(world, body, (1.0, 0.0, 0.0), duration=-1.0)
    world.run(100)
    world.external_forces.cancel(lambda target: target.scoped_name == 'body::link')
    world.run(100)
    assert body.twist.linear[0] == pytest.approx(0.1, abs=0.0015)


def test_forces_and_holds_end_with_a_reset_to_time_zero(world, body):
    push(world, body, (1.0, 0.0, 0.0), duration=-1.0)
    world.holds.hold(body, Pose((5.0, 0.0, 500.0)), lambda: True)
    world.reset_simulation()
    world.run(100)
    assert body.pose == HIGH


def test_forces_end_with_the_deletion_of_their_model(world, body):
    push(world, body, (1.0, 0.0, 0.0), duration=-1.0)
    world.delete('body')
    world.run(10)
    assert list(world.models) == ['ground_plane']


def pendulum():
    base = LinkSpec('base', inertial=Inertial(1.0, Pose(), 1.0, 1.0, 1.0))
    arm = LinkSpec('arm', inertial=Inertial(1.0, Pose(), *MOMENTS))
    return ModelSpec(
        'pendulum',
        (base, arm),
        (
            JointSpec('bolt', 'fixed', 'world', 'base'),
            JointSpec('hinge', 'revolute', 'base', 'arm', axis=(0.0, 0.0, 1.0)),
        ),
    )


def test_effort_accelerates_a_joint_by_its_inertia(world):
    model = world.spawn(pendulum(), 'pendulum', HIGH)
    joint = model.joint('hinge')
    world.external_forces.add(joint, lambda: joint.apply_effort(0.1), 0, SECOND_NS)
    world.run(1500)
    assert joint.velocity == pytest.approx(0.1 / MOMENTS[2], rel=0.01)


def test_model_keeps_its_motion_when_its_description_changes(world, robot):
    world.run(2500)
    robot.plugin('diff_drive').command(0.5, 0.0)
    world.run(2000)
    before, joint = robot.state(), robot.joint('wheel_left_joint').state()
    robot.respecify(robot.spec)
    assert robot.pose.position == pytest.approx(before[0].position, abs=1e-9)
    assert robot.twist.linear == pytest.approx(before[1].linear, abs=1e-9)
    assert robot.joint('wheel_left_joint').state() == pytest.approx(joint, abs=1e-9)
    world.run(1000)
    assert robot.twist.linear[0] == pytest.approx(before[1].linear[0], abs=0.01)


def test_moving_a_root_link_moves_its_descendants(robot):
    wheel = robot.links['wheel_left_link']
    apart = wheel.pose.position[1] - robot.pose.position[1]
    target = Pose((3.0, 4.0, 1.0))
    robot.move_link(robot.links['base_footprint'], target, Twist((0.1, 0.0, 0.0)))
    assert robot.pose.position == pytest.approx(target.position)
    assert wheel.pose.position[1] == pytest.approx(4.0 + apart)
    assert robot.twist.linear == pytest.approx((0.1, 0.0, 0.0))


def test_moving_another_link_moves_the_whole_model(robot):
    wheel = robot.links['wheel_left_link']
    target = Pose((3.0, 4.0, 1.0), from_rpy(0.0, 0.0, 1.0))
    robot.move_link(wheel, target, Twist((0.1, 0.2, 0.0), (0.0, 0.0, 1.0)))
    assert wheel.pose.position == pytest.approx(target.position, abs=1e-6)
    assert wheel.twist.linear == pytest.approx((0.1, 0.2, 0.0), abs=1e-6)
    assert wheel.twist.angular == pytest.approx((0.0, 0.0, 1.0), abs=1e-6)
