"""A saved state: bit-identical continuation after every restore."""

import hashlib

import pytest
from support import XACRO, box_urdf

from rosbots_description.sim import PhysicsSettings, Pose, SimError, World
from rosbots_description.sim.formats.urdf import expand_xacro
from rosbots_description.sim.resources import PackageSearch

CRATE = f'<robot name="crate">{box_urdf("1 1 1", 2.0)}</robot>'
WATCHER = """<sdf version="1.6"><model name="puck"><link name="l">
<inertial><mass>1</mass></inertial>
<collision name="c"><geometry><box><size>1 1 0.2</size></box></geometry></collision></link>
<plugin name="move" filename="libgazebo_ros_planar_move.so"><odometryRate>30</odometryRate></plugin>
</model></sdf>"""


def digest(world, steps=1500, chunk=70):
    """Return a hash of all states and readings."""
    found = hashlib.sha256()
    for _ in range(0, steps, chunk):
        world.run(chunk)
        for model in world.models.values():
            found.update(repr((world.time, model.state(), model.joint_states)).encode())
            for plugin in model.plugins.values():
                for output in plugin.outputs.values():
                    found.update(repr(output.latched).encode())
    return found.hexdigest()


def driving_robot(world):
    """Spawn the robot with all outputs read, and drive it."""
    robot = world.spawn(XACRO, z=0.5)
    drive = robot.plugin('diff_drive')
    for output in drive.outputs.values():
        output.latch()
    world.run(seconds=0.7)
    drive.command(0.6, 0.4)
    world.run(337)
    return robot


@pytest.mark.parametrize('name', ['empty', 'room', 'maze', 'shapes'])
def test_continuation_after_each_restore_is_bit_identical(name):
    with World.from_file(name) as world:
        robot = driving_robot(world)
        state = world.save_state()
        first = digest(world)
        for change in (
            lambda: None,
            lambda: robot.plugin('diff_drive').command(-1.0, 0.0),
            lambda: robot.set_pose(Pose((2.0, 2.0, 3.0))),
            lambda: world.set_physics(PhysicsSettings(step_size=0.003)),
            lambda: robot.scale_mass(1.7),
            lambda: [link.scale_friction(0.1) for link in robot.links.values()],
            world.reset_world,
        ):
            world.restore(state)
            change()
            world.run(613)
            world.restore(state)
            assert digest(world) == first


def test_encoder_odometry_is_restored(world):
    text = expand_xacro(str(XACRO), {}, PackageSearch()).replace(
        '<legacyMode>', '<odometrySource>encoder</odometrySource><legacyMode>'
    )
    drive = world.spawn(text, z=0.5).plugin('diff_drive')
    drive.odometry.latch()
    drive.command(0.5, 0.3)
    world.run(seconds=1.0)
    assert drive.every_step
    state, first = world.save_state(), None
    for _ in range(3):
        found = digest(world, 700)
        assert found == (first or found)
        first = found
        world.restore(state)


def test_time_forces_commands_and_readings_are_restored(world):
    robot, crate = driving_robot(world), world.spawn(CRATE, x=3.0, z=0.5)
    drive = robot.plugin('diff_drive')
    world.apply_wrench(crate.link('box'), (30.0, 0.0, 0.0), seconds=0.2)
    world.run(seconds=0.1)
    state = world.save_state()
    then, reading = (world.time, crate.state(), robot.state()), drive.odometry.newest
    world.run(seconds=0.1)
    moved = crate.pose
    world.clear_forces(crate.link('box'))
    drive.command(0.0, 0.0)
    world.lights.clear()
    world.run(seconds=1.0)
    world.restore(state)
    assert (world.time, crate.state(), robot.state()) == then
    assert drive.odometry.newest == reading
    assert (drive.target, list(world.lights)) == ((0.6, 0.0, 0.4), ['sun'])
    world.run(seconds=0.1)
    assert crate.pose == moved


def test_models_are_held_again_after_a_restore(world):
    crate, high = world.spawn(CRATE, z=0.5), Pose((0.0, 0.0, 5.0))
    loose = world.save_state()
    world.run(500)
    world.holds.hold(crate, high, lambda: True)
    held = world.save_state()
    world.restore(loose)
    world.run(500)
    assert crate.pose.position[2] == pytest.approx(0.5, abs=1e-3)
    world.restore(held)
    world.run(500)
    assert crate.pose.position[2] == pytest.approx(5.0, abs=1e-3)


def test_readers_are_not_restored(world):
    drive = world.spawn(WATCHER, z=0.1).plugin('planar_move')
    drive.command(0.3, 0.1)
    unread, old, new = world.save_state(), [], []
    drive.odometry.connect(old.append)
    world.run(seconds=0.5)
    read = world.save_state()
    world.restore(unread)
    world.run(seconds=0.5)
    assert len(old) == 2 * 14  # periods of 34 ms in 0.5 s
    drive.odometry.disconnect(old.append)
    drive.odometry.connect(new.append)
    world.restore(read)
    world.run(seconds=0.5)
    assert (len(old), len(new)) == (28, 15)
    assert new[-1].twist.linear[0] == pytest.approx(0.3, rel=0.05)


def test_several_states_can_be_restored_in_any_order(world):
    robot, states, poses = driving_robot(world), [], []
    for _ in range(3):
        states.append(world.save_state())
        poses.append(robot.state())
        world.run(200)
    for i in (1, 0, 2, 2, 1):
        world.restore(states[i])
        assert robot.state() == poses[i]
        world.run(50)


def test_state_of_another_world_or_other_models_is_rejected():
    with World.empty() as world, World.empty() as other:
        state = world.save_state()
        with pytest.raises(SimError, match='another world'):
            other.restore(state)
        world.spawn(CRATE, z=0.5)
        with pytest.raises(SimError, match='ground_plane, and now there are ground_plane, crate'):
            world.restore(state)
        world.delete('crate')
        world.restore(state)


def test_state_of_a_closed_world_does_not_affect_another():
    with World.empty() as world:
        old = world.save_state()
    with World.empty() as world:
        robot = driving_robot(world)
        state = world.save_state()
        del old
        pose = robot.pose
        world.run(100)
        world.restore(state)
        assert robot.pose == pose


def test_state_from_before_a_reset_is_rejected(world):
    state = world.save_state()
    world.reset_simulation()
    with pytest.raises(SimError, match='take a new one'):
        world.restore(state)


def test_diverged_robot_is_restored(world):
    robot = driving_robot(world)
    state, first = world.save_state(), None
    first = digest(world, 300)
    world.apply_wrench(robot.link('base_footprint'), (1e14, 0.0, 0.0), seconds=0.01)
    world.run(20)
    world.restore(state)
    assert digest(world, 300) == first
