"""The world runs on another engine, which the caller of the public World chooses."""

import math

import pytest
from support import ROOT
from support.kinematic_engine import KinematicEngine

from rosbots_description.sim import World, yaw_of

ROBOT = ROOT / 'urdf' / 'rosbots.xacro'
RADIUS, SEPARATION = 0.23, 0.88  # of the wheels' shapes [m]
DIAMETER, TRACK = 0.52, 1.1  # wheelDiameter and wheelSeparation of the plugin [m]


@pytest.fixture
def world():
    with World.empty(make_engine=KinematicEngine) as world:
        yield world


def test_the_robot_of_the_tutorial_drives_as_its_wheels_roll(world):
    robot = world.spawn(ROBOT, 'rosbots')
    robot.plugin('diff_drive').command(0.5, 0.0)
    world.run(seconds=1.0)
    start = robot.pose.position
    world.run(seconds=2.0)
    x, y, z = robot.pose.position
    rolled = 0.5 * RADIUS / (0.5 * DIAMETER)  # [m/s]
    assert x - start[0] == pytest.approx(2.0 * rolled, rel=1e-6)
    assert (y, z) == pytest.approx((0.0, 0.0), abs=1e-9)  # nothing falls, and it starts at z = 0
    robot.plugin('diff_drive').command(0.0, 0.4)
    world.run(seconds=0.5)
    before = yaw_of(robot.pose.orientation)
    world.run(seconds=1.0)
    turned = 0.4 * TRACK / DIAMETER * 2.0 * RADIUS / SEPARATION  # [rad]
    assert yaw_of(robot.pose.orientation) - before == pytest.approx(turned, rel=1e-3)
    assert robot.twist.linear[2] == 0.0


def test_worlds_are_saved_restored_and_read_from_files():
    with World.from_file('room', make_engine=KinematicEngine) as world:
        robot = world.spawn(ROBOT, 'rosbots')
        drive = robot.plugin('diff_drive')
        drive.command(0.5, 0.3)
        world.run(seconds=0.5)
        state = world.save_state()
        world.run(seconds=1.0)
        end = robot.pose
        world.restore(state)
        world.run(seconds=1.0)
        assert robot.pose == end
        world.delete('rosbots')
        assert 'rosbots' not in world.models


def test_wheels_turn_by_their_positions(world):
    robot = world.spawn(ROBOT, 'rosbots')
    robot.plugin('diff_drive').command(0.5, 0.0)
    world.run(seconds=1.0)
    before = {name: joint.position for name, joint in robot.joints.items()}
    world.run(seconds=1.0)
    wheels = [name for name, joint in robot.joints.items() if 'wheel' in joint.spec.child]
    for name in wheels[:2]:
        assert abs(robot.joints[name].position - before[name]) == pytest.approx(
            0.5 / (0.5 * DIAMETER), rel=1e-6
        )
    assert math.isfinite(sum(joint.position for joint in robot.joints.values()))
