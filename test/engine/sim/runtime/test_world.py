"""The world: spawns and deletions, resets, names, plugins and listeners."""

import math
from dataclasses import replace
from pathlib import Path

import pytest
from support import SETTLED, SPAWN_POSE, box_urdf, robot_spec, urdf_spec
from support.scenes import with_tags

from rosbots_description.sim.core.errors import ModelError, NotFoundError
from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.description.model_spec import (
    Box,
    Collision,
    Element,
    Inertial,
    LinkSpec,
    Mesh,
    ModelSpec,
    PluginSpec,
)
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.plugins.drive.diff_drive import DiffDrive
from rosbots_description.sim.runtime.scheduler import Hook

BOX = urdf_spec(box_urdf('1 1 1', 1.0))
MEGABYTE = 2**20
LEAK_ALLOWED = 6 * MEGABYTE  # 14 without the rebuild
CYCLES = 200


def resident_bytes():
    pages = int(Path('/proc/self/statm').read_text(encoding='ascii').split()[1])
    return pages * 4096


def test_the_robot_has_gazebos_links_and_mass(robot):
    assert [link.scoped_name for link in robot.links.values()] == [
        'rosbots::base_footprint',
        'rosbots::wheel_left_link',
        'rosbots::wheel_right_link',
    ]
    assert sum(link.inertial.mass for link in robot.spec.links) == pytest.approx(1.4)


def test_order_of_a_step_is_time_hooks_physics(world):
    class Watch(Hook):
        due = 1

        def before_step(self):
            seen.append((world.clock.steps, model.pose.position[2]))

    seen = []
    model = world.spawn(BOX, 'box', Pose((0, 0, 5.0)))
    world.schedule.add(Watch())
    world.run(1)
    assert seen == [(1, 5.0)]
    assert model.pose.position[2] < 5.0


def test_reset_world_resets_poses_and_keeps_time_and_joint_angles(world, robot):
    world.run(SETTLED)
    robot.plugin('diff_drive').command(0.5, 0.0)
    world.run(2000)
    angle = robot.joint('wheel_left_joint').position
    world.reset_world()
    assert world.clock.steps == SETTLED + 2000
    assert robot.pose.position == pytest.approx(SPAWN_POSE.position)
    assert robot.twist.linear == pytest.approx((0.0, 0.0, 0.0))
    assert angle > 1.0
    assert robot.joint('wheel_left_joint').position == pytest.approx(angle)
    world.run(SETTLED)
    standing = robot.pose.position
    world.run(1000)
    assert math.dist(standing, robot.pose.position) < 1e-3  # the command is cleared


def test_repeated_spawns_and_deletions_do_not_leak_memory(world):
    neighbour = world.spawn(BOX, 'box', Pose((5, 5, 0.5)))
    before = None
    for cycle in range(CYCLES):
        model = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
        if cycle % 2:
            next(iter(model.plugins.values())).command(0.5, 0.5)
        world.run(30)
        world.delete('rosbots')
        if cycle == 20:
            before = resident_bytes()
    assert resident_bytes() - before < LEAK_ALLOWED
    assert list(world.models) == ['ground_plane', 'box']
    assert neighbour.pose.position == pytest.approx((5.0, 5.0, 0.5), abs=1e-3)


def test_duplicate_and_empty_names_are_rejected(world):
    world.spawn(BOX, 'box', Pose((0, 0, 2.0)))
    with pytest.raises(ModelError, match="'box' is in the world already"):
        world.spawn(BOX, 'box', Pose((0, 0, 4.0)))
    with pytest.raises(ModelError, match='needs a name'):
        world.spawn(BOX, '', Pose((0, 0, 4.0)))
    with pytest.raises(NotFoundError, match="no model named 'ball'"):
        world.delete('ball')


def test_entities_are_found_by_plain_and_scoped_names_in_world_order(world):
    world.spawn(robot_spec(), 'one', SPAWN_POSE)
    world.spawn(robot_spec(), 'two', Pose((3.0, 0.0, 0.5)))
    assert world.find_entity('wheel_left_link').scoped_name == 'one::wheel_left_link'
    assert world.find_entity('two::wheel_left_link').scoped_name == 'two::wheel_left_link'
    assert world.find_model('two').name == 'two'
    assert world.find_model('wheel_left_link') is None
    assert world.find_joint('two::wheel_left_joint').model.name == 'two'
    assert world.find_entity('base_link') is None  # reduced
    collision = world.find_entity('wheel_left_link_collision')
    assert collision.state()[0].position[1] == pytest.approx(0.5125, abs=1e-3)


def test_links_of_nested_models_are_found_by_each_of_their_names(world):
    body = LinkSpec('inner::body', inertial=Inertial(1.0, Pose(), 0.1, 0.1, 0.1))
    link = world.spawn(ModelSpec('outer', (body,)), 'outer', Pose()).links['inner::body']
    for name in ('outer::inner::body', 'inner::body', 'body'):
        assert world.find_entity(name) is link


NESTED = """<sdf version="1.6"><model name="outer">
  <link name="base"><inertial><mass>1</mass></inertial></link>
  <model name="arm"><pose>1 0 0 0 0 0</pose>
    <link name="upper"><pose>0 0 0.5 0 0 0</pose><inertial><mass>1</mass></inertial></link>
    <model name="hand"><pose>0 0 1 0 0 0</pose>
      <link name="palm"><inertial><mass>1</mass></inertial></link></model>
  </model></model></sdf>"""


def test_nested_models_have_their_own_names_and_frames(world):
    spec, _ = load_sdf(NESTED, 'robot', source='test', find_model=lambda _: None)
    world.spawn(spec, 'robot', Pose((0.0, 0.0, 5.0)))
    for name in ('robot::arm', 'arm'):
        arm = world.find_model(name)
        assert arm.scoped_name == 'robot::arm'
        assert arm.parent_name == 'robot'
    assert arm.state()[0].position == pytest.approx((1.0, 0.0, 5.0))
    assert world.frame('hand')[0].position == pytest.approx((1.0, 0.0, 6.0))
    assert world.find_model('hand').parent_name == 'arm'
    assert [link.name for link in arm.spec.links] == ['upper', 'hand::palm']
    arm.set_pose(Pose((2.0, 0.0, 7.0)))
    assert arm.state()[0].position == pytest.approx((2.0, 0.0, 7.0))


@pytest.mark.parametrize('name', ['', 'world', 'map', '/map'])
def test_each_name_of_the_world_is_accepted(world, name):
    assert world.frame(name)[0] == Pose()


def test_an_unknown_frame_is_an_error(world):
    with pytest.raises(NotFoundError, match="'base_link'"):
        world.frame('base_link')


def test_model_is_spawned_without_an_unknown_plugin(world, caplog):
    plugin = PluginSpec('p', 'libnope.so', Element('plugin'))
    model = world.spawn(replace(BOX, plugins=(plugin,)), 'b', Pose())
    assert model.plugins == {}
    assert model.left_out == ["plugin 'libnope.so'"]
    assert caplog.messages == [
        "model 'b', plugin 'p': unknown library 'libnope.so'; nothing is loaded "
        'from GAZEBO_PLUGIN_PATH; see doc/gazebo_compatibility.md'
    ]


def test_a_plugin_that_is_known_but_not_supported_is_a_warning(world, caplog):
    plugin = PluginSpec('imu', 'libgazebo_ros_elevator.so', Element('plugin'))
    model = world.spawn(replace(BOX, plugins=(plugin,)), 'b', Pose())
    assert model.left_out == ["plugin 'libgazebo_ros_elevator.so'"]
    assert [(r.levelname, r.getMessage()) for r in caplog.records] == [
        (
            'WARNING',
            "model 'b', plugin 'imu': libgazebo_ros_elevator.so is known but not supported "
            'yet; see doc/gazebo_compatibility.md',
        )
    ]


def test_model_is_spawned_without_a_failing_plugin(world, caplog):
    drive = PluginSpec('d', 'libgazebo_ros_diff_drive.so', Element('plugin'))
    model = world.spawn(replace(BOX, plugins=(drive,)), 'b', Pose())
    assert model.plugins == {}
    world.run(10)
    assert "couldn't get wheel hinge joint named left_joint" in caplog.text


def test_failing_plugin_does_not_set_motors(world):
    broken = with_tags(
        robot_spec(),
        lambda tags: (replace(t, text='nowhere') if t.tag == 'rightJoint' else t for t in tags),
    )
    model = world.spawn(broken, 'rosbots', SPAWN_POSE)
    assert model.plugins == {}
    assert model.body.motors['wheel_left_joint'] == (0.0, 0.0)


def test_failed_spawn_leaves_nothing_behind(world, monkeypatch):
    def break_down(plugin):
        raise RuntimeError('internal error')

    monkeypatch.setattr(DiffDrive, 'load', break_down)
    with pytest.raises(RuntimeError):
        world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
    monkeypatch.undo()
    assert list(world.models) == ['ground_plane']
    world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
    world.run(SETTLED)
    world.delete('rosbots')


def test_partly_created_body_is_removed(world):
    good, bad = (
        LinkSpec(name, Pose((0.0, 0.0, height)), collisions=(Collision('c', shape),))
        for name, height, shape in (
            ('good', 0.5, Box((1.0, 1.0, 1.0))),
            ('bad', 5.0, Mesh('/no/such/mesh.obj')),
        )
    )
    ball = urdf_spec(box_urdf('0.2 0.2 0.2', 1.0))
    with pytest.raises(ModelError):
        world.spawn(ModelSpec('wall', (good, bad), static=True), 'wall', Pose())
    box = world.spawn(ball, 'box', Pose((0.0, 0.0, 2.0)))
    world.run(1500)
    assert box.pose.position[2] == pytest.approx(0.1, abs=0.01)  # no invisible body in its way


def test_reset_world_resets_static_models(world):
    static = box_urdf('1 1 1', 1.0, '<gazebo><static>true</static></gazebo>')
    wall = world.spawn(urdf_spec(static), 'wall', Pose((1.0, 0.0, 0.5)))
    wall.set_pose(Pose((7.0, 0.0, 0.5)))
    world.reset_world()
    assert wall.pose.position == pytest.approx((1.0, 0.0, 0.5))


def test_listeners_are_notified_of_spawns_deletions_and_resets(world):
    class Listener:
        def model_spawned(self, model):
            heard.append(('spawned', model.name, len(model.plugins)))

        def model_deleted(self, model):
            heard.append(('deleted', model.name, len(model.plugins)))

        def world_reset(self):
            heard.append('reset')

    heard = []
    world.listeners.append(Listener())
    world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
    world.reset_world()
    world.delete('rosbots')
    assert heard == [('spawned', 'rosbots', 1), 'reset', ('deleted', 'rosbots', 1)]


def test_engine_prints_nothing(world, capfd):
    world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
    world.run(100)
    world.reset_simulation()
    world.run(100)
    result = capfd.readouterr()
    assert 'b3' not in result.out + result.err
    assert 'pybullet' not in result.out + result.err
