"""The public World: arguments, results, and errors."""

import importlib
import math
import subprocess
import sys

import pytest
from support import ROOT, XACRO, box_urdf, empty_world, robot_spec
from support.refusals import sentence_of

from rosbots_description import sim
from rosbots_description.sim import (
    ModelError,
    NotFoundError,
    PhysicsSettings,
    Pose,
    SimError,
    World,
    from_rpy,
    yaw_of,
)

WEIGHTLESS = PhysicsSettings(gravity=(0.0, 0.0, 0.0))
CRATE = f'<robot name="crate">{box_urdf("1 1 1", 2.0)}</robot>'
CRATE_SDF = """<sdf version="1.6"><model name="crate"><pose>0 0 1 0 0 0</pose><link name="box">
<collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision></link></model>
</sdf>"""
PENDULUM = f"""<robot name="pendulum"><link name="world"/>{box_urdf('1 1 1', 2.0)}
<joint name="hinge" type="continuous"><parent link="world"/><child link="box"/><axis xyz="0 0 1"/>
</joint></robot>"""


def test_robot_moves_as_in_the_world_of_the_server(world):
    robot = world.spawn(XACRO, z=0.5)
    robot.plugin('diff_drive').command(0.5, 0.2)
    world.run(seconds=1.5)
    with empty_world() as inner:
        other = inner.spawn(robot_spec(), 'rosbots', Pose((0.0, 0.0, 0.5)))
        next(iter(other.plugins.values())).command(0.5, 0.2)
        inner.run(1500)
        assert (robot.name, robot.state()) == ('rosbots', other.state())


@pytest.mark.parametrize('text', [CRATE, CRATE_SDF, f'\ufeff\n {CRATE}'])
def test_text_is_spawned_under_its_name_or_a_given_one(world, text):
    assert world.spawn(text, x=-3.0) is world.model('crate')
    assert world.spawn(text, 'other', x=3.0).name == 'other'


def test_file_and_uri_are_spawned(world, tmp_path):
    folder = tmp_path / 'crate'
    folder.mkdir()
    (folder / 'model.sdf').write_text(CRATE_SDF, encoding='utf-8')
    world.spawn(folder / 'model.sdf')
    with World(model_path=[tmp_path]) as other:
        there = other.spawn('model://crate', 'there', x=2.0)
        assert there.pose.position == (2.0, 0.0, 0.0)  # as in Gazebo, that of the <include>
        assert other.spawn('model://crate').name == 'crate'


def test_model_is_spawned_at_the_given_pose(world):
    first = world.spawn(CRATE, 'first', x=1.0, y=2.0, z=3.0, yaw=0.5)
    assert first.pose.position == (1.0, 2.0, 3.0)
    assert yaw_of(first.pose.orientation) == pytest.approx(0.5)
    pose = Pose((4.0, 5.0, 6.0), from_rpy(0.1, 0.2, 0.3))
    assert world.spawn(CRATE, 'second', pose).pose.orientation == pytest.approx(pose.orientation)


def test_compiled_model_can_be_spawned_repeatedly(world):
    compiled = world.compile(robot_spec())
    for i, name in enumerate(('', 'second')):
        world.spawn(compiled, name, x=2.0 * i, z=0.5)
    assert list(world.models) == ['ground_plane', robot_spec().name, 'second']


def test_xacro_arguments_are_passed(world, tmp_path):
    file = tmp_path / 'crate.xacro'
    file.write_text(
        '<robot name="crate" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        f'<xacro:arg name="mass" default="2"/>{box_urdf("1 1 1", "$(arg mass)")}</robot>'
    )
    plain = world.spawn(file, z=1.0)
    heavy = world.spawn(file, 'heavy', x=3.0, arguments={'mass': '5'})
    assert [model.spec.links[0].inertial.mass for model in (plain, heavy)] == [2.0, 5.0]


@pytest.mark.parametrize(
    ('spawn', 'message'),
    [
        (lambda world: world.spawn('nowhere.urdf'), "'nowhere.urdf' cannot be read: No such file"),
        (lambda world: world.spawn('<html/>'), '<robot> (URDF) or <sdf>, not <html>'),
        (lambda world: world.spawn('<!-- -->'), '<robot> (URDF) or <sdf>, not missing'),
        (lambda world: world.spawn('<robot/>', 'thing'), 'link'),
        (lambda world: world.spawn('<robot><link name="l"/></robot>'), 'give one with name='),
        (lambda world: world.spawn('package://nobodys/robot.urdf'), "package 'nobodys'"),
        (lambda world: world.spawn('model://nothing'), "'model://nothing' is not to be found"),
        (lambda world: world.spawn(CRATE, 'ground_plane'), "named 'ground_plane' is in the world"),
        (lambda world: world.spawn(CRATE, x=1e300), 'm away'),
        (lambda _: World.from_file('nowhere.world'), "no world file 'nowhere.world'"),
        (lambda _: World.from_file(XACRO), 'an SDF begins with <sdf'),
    ],
)
def test_error_of_a_spawn_is_one_sentence(world, spawn, message):
    assert message in sentence_of(SimError, spawn, world)
    assert list(world.models) == ['ground_plane']


@pytest.mark.parametrize(
    'call',
    [
        lambda world: world.spawn(CRATE, z=math.nan),
        lambda world: world.spawn(CRATE, pose=Pose((0.0, math.inf, 0.0))),
        lambda world: world.spawn(CRATE, pose=Pose(), z=1.0),
        lambda world: world.run(),
        lambda world: world.run(3, seconds=0.1),
        lambda world: world.run(1.0),
        lambda world: world.run(seconds=-1.0),
        lambda world: world.run(seconds=math.inf),
        lambda world: world.step(-1),
        lambda world: world.apply_effort(world.spawn(PENDULUM).joint('hinge'), math.nan),
        lambda world: world.apply_wrench(world.spawn(CRATE).link('box'), (math.inf, 0.0, 0.0)),
        lambda world: world.apply_wrench(world.spawn(CRATE).link('box'), seconds=-1.0),
        lambda world: world.spawn(XACRO).plugin('diff_drive').command(math.nan, 0.0),
    ],
)
def test_invalid_number_is_a_value_error(world, call):
    with pytest.raises(ValueError, match=r'\w+ (takes|goes|is|got)'):
        call(world)


def test_parts_print_as_their_kind_and_name(world):
    robot = world.spawn(XACRO, 'robot')
    world.run(3)
    assert repr(world) == '<World at 0.003 s with ground_plane, robot>'
    assert repr(robot) == '<Model robot>'
    assert repr([*robot.links.values()][:1]) == '[<Link robot::base_footprint>]'
    assert repr(robot.joint('wheel_left_joint')) == '<Joint robot::wheel_left_joint>'
    drive = 'differential_drive_controller'
    assert repr(robot.plugins) == f"{{'{drive}': <DiffDrive {drive}>}}"
    collision = next(iter(robot.link('wheel_left_link').collisions.values()))
    assert repr(collision) == f'<CollisionFrame robot::wheel_left_link::{collision.name}>'


def test_outputs_states_and_clock_print_what_they_hold(world):
    odometry = world.spawn(XACRO, 'robot').plugin('diff_drive').odometry
    assert repr(odometry) == '<Output with 0 readers>'
    odometry.latch()
    assert repr(odometry) == '<Output with 1 reader, latched>'
    world.run(3)
    assert repr(world.clock) == '<SimClock at 0.003 s, step 3>'
    assert repr(world.save_state()) == '<SavedState at 0.003 s with ground_plane, robot>'


def test_time_advances_by_steps_and_by_seconds():
    with World(PhysicsSettings(step_size=0.002)) as world:
        assert (world.step(), world.time) == (1, 0.002)
        assert (world.run(9), world.time) == (9, 0.02)
        assert (world.run(seconds=0.1), world.time) == (50, 0.12)
        assert (world.run(seconds=0.0), world.time) == (0, 0.12)


def test_world_file_gives_models_lights_and_time():
    with World.from_file('room') as world:
        assert 'bookcase' in world.models
        assert list(world.lights) == ['sun']


def test_links_joints_and_plugins_are_found_by_name_or_the_error_lists_them(world):
    robot = world.spawn(XACRO, 'robot', z=0.5)
    assert robot.link('robot::wheel_left_link') is robot.link('wheel_left_link')
    assert robot.joint('robot::wheel_left_joint') is robot.joint('wheel_left_joint')
    (plugin,) = robot.plugins.values()
    for name in (
        'differential_drive_controller',
        'diff_drive',
        'libgazebo_ros_diff_drive.so',
        'gazebo_ros_diff_drive',
    ):
        assert robot.plugin(name) is plugin
    for find, known in (
        (robot.link, 'base_footprint, wheel_left_link'),
        (world.model, 'robot'),
        (robot.plugin, "'differential_drive_controller' (libgazebo_ros_diff_"),
    ):
        assert known in sentence_of(NotFoundError, find, 'nothing')


def test_models_links_joints_plugins_and_sensors_are_dicts_by_name(world):
    robot = world.spawn(XACRO, 'robot', z=0.5, arguments={'laser': 'true', 'imu': 'true'})
    assert list(robot.sensors) == ['imu', 'laser']
    assert list(robot.plugins) == [
        'differential_drive_controller',
        'imu_controller',
        'laser_controller',
    ]
    for found, find in (
        (world.models, world.model),
        (robot.links, robot.link),
        (robot.joints, robot.joint),
        (robot.plugins, robot.plugin),
        (robot.sensors, robot.sensor),
    ):
        assert found
        for name, one in found.items():
            assert one is find(name)
            assert one.name == name


def test_plugins_and_sensors_of_one_name_have_different_keys(world):
    push = (
        '<plugin name="{}" filename="libgazebo_ros_force.so"><bodyName>b</bodyName>'
        '<topicName>t</topicName></plugin>'
    )
    inner = '<plugin name="push" filename="libgazebo_ros_bumper.so"/>'
    contact = (
        '<sensor name="feel" type="contact">{}<contact><collision>c</collision></contact></sensor>'
    )
    link = (
        '<link name="{}"><collision name="c"><geometry><sphere><radius>0.1</radius></sphere>'
        '</geometry></collision>{}</link>'
    )
    model = world.spawn(
        '<sdf version="1.6"><model name="m">'
        + link.format('a', contact.format(inner))
        + link.format('b', contact.format(''))
        + 3 * push.format('push')
        + push.format('')
        + '</model></sdf>'
    )
    assert [*model.sensors] == ['feel', 'b::feel']
    assert [*model.plugins] == [
        'push',
        'push_2',
        'push_3',
        'libgazebo_ros_force.so',
        'a::feel::push',
    ]
    assert len({*model.plugins.values()}) == 5
    for key, plugin in model.plugins.items():
        assert model.plugin(key) is plugin
    for key, sensor in model.sensors.items():
        assert model.sensor(key) is sensor
    assert model.sensor('a::feel') is model.sensors['feel']


def test_joint_states_are_those_of_the_joints(world):
    robot = world.spawn(XACRO, z=0.5)
    robot.plugin('diff_drive').command(0.5, 0.0)
    world.run(seconds=1.0)
    states = robot.joint_states
    for name, *numbers in zip(*states, strict=True):
        joint = robot.joint(name)
        assert numbers == [joint.position, joint.velocity, joint.effort]
    assert max(states.velocities) > 1.0
    assert world.model('ground_plane').joint_states == ((), (), (), ())


def test_latched_output_has_its_latest_reading(world):
    odometry = world.spawn(XACRO, z=0.5).plugin('diff_drive').odometry
    with pytest.raises(NotFoundError, match='call its latch'):
        _ = odometry.newest
    odometry.latch()
    with pytest.raises(NotFoundError, match='no reading yet'):
        _ = odometry.newest
    seen = []
    odometry.connect(seen.append)
    world.run(seconds=0.1)
    odometry.latch()  # again, which changes nothing
    assert odometry.newest is seen[-1]
    assert len(seen) == 9  # 100 Hz, from the first step after 10 ms


def test_wrench_gives_the_momentum_of_mechanics():
    with World(WEIGHTLESS) as world:
        link = world.spawn(CRATE).link('box')
        world.apply_wrench(link, (4.0, 0.0, 0.0), (0.0, 0.0, 0.01), seconds=0.5)
        world.run(seconds=1.0)
        assert link.twist.linear == pytest.approx((1.0, 0.0, 0.0))  # F t / m
        assert link.twist.angular == pytest.approx((0.0, 0.0, 0.05))  # M t / I
        world.apply_wrench(link, (-4.0, 0.0, 0.0))
        world.run(seconds=0.25)
        world.clear_forces(link)
        world.run(seconds=1.0)
        assert link.twist.linear[0] == pytest.approx(0.5)


def test_effort_turns_a_joint_until_it_is_cleared():
    with World(WEIGHTLESS) as world:
        hinge = world.spawn(PENDULUM).joint('hinge')
        world.apply_effort(hinge, 0.2)
        world.run(seconds=0.1)
        assert hinge.velocity == pytest.approx(0.2)  # M t / I
        world.clear_forces(hinge)
        world.run(seconds=0.1)
        assert hinge.velocity == pytest.approx(0.2)


def test_use_of_a_closed_world_is_an_error(world):
    world.step()
    world.close()
    for call in (world.step, lambda: world.spawn(CRATE)):
        with pytest.raises(SimError, match='this world is closed'):
            call()


def test_failed_load_of_a_world_closes_everything(tmp_path, monkeypatch):
    closed = []

    def close(world):
        closed.append(world)

    monkeypatch.setattr(World, 'close', close)
    file = tmp_path / 'broken.world'
    file.write_text(
        '<sdf version="1.6"><world name="w"><physics type="ode">'
        '<max_step_size>none</max_step_size></physics></world></sdf>'
    )
    with pytest.raises(ModelError, match='max_step_size'):
        World.from_file(file)
    assert len(closed) == 1


def test_every_public_name_is_typed_and_documented():
    for name in sim.__all__:
        rooms = [
            importlib.import_module(f'rosbots_description.sim.{room}')
            for room in ('core', 'description', 'runtime', 'public')
        ]
        found = {id(getattr(room, name)) for room in rooms if name in room.__all__}
        assert {id(getattr(sim, name))} <= found
        assert getattr(sim, name).__doc__
    with pytest.raises(AttributeError, match='Wrold'):
        _ = sim.Wrold


def test_import_of_an_error_or_a_pose_loads_no_engine():
    code = (
        'import sys; from rosbots_description.sim import ModelError, Pose; '
        "print([name for name in ('pybullet', 'numpy', 'lxml') if name in sys.modules])"
    )
    ended = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, check=True, cwd=ROOT / 'src'
    )
    assert ended.stdout.strip() == '[]'
