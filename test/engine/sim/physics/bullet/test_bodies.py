"""Bodies move by rigid-body mechanics and as described."""

import gc
import math
from pathlib import Path

import pytest
from support import ROOT, SPAWN_POSE, box_urdf, robot_spec, urdf_spec

from rosbots_description.sim.core.transforms import Pose, Twist, from_rpy, to_rpy
from rosbots_description.sim.description.model_spec import Inertial, LinkSpec, ModelSpec
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.resources.search_path import ModelSearch

SECOND = 1000  # steps

ARM = """
<link name="post"><inertial><mass value="5"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="arm"><inertial><origin xyz="0.5 0 0"/><mass value="1"/>
  <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="world_joint" type="fixed"><parent link="world"/><child link="post"/>
  <origin xyz="0 0 2"/></joint>
<link name="world"/>
<joint name="hinge" type="{type}"><parent link="post"/><child link="arm"/><axis xyz="0 1 0"/>
  {motion}</joint>
"""


def free_ball(inertial):
    return ModelSpec('ball', (LinkSpec('link', inertial=inertial),))


def test_a_free_fall_has_no_drag(world):
    spec = free_ball(Inertial(1.0, ixx=0.1, iyy=0.1, izz=0.1))
    model = world.spawn(spec, 'ball', Pose((0.0, 0.0, 100.0)))
    world.run(2 * SECOND)
    assert model.twist.linear[2] == pytest.approx(-19.6, rel=1e-6)


def test_the_pose_is_that_of_the_link_frame_not_of_the_centre_of_mass(world):
    spec = free_ball(Inertial(1.0, Pose((0.3, 0.2, 0.1)), 0.1, 0.2, 0.25, ixy=0.03))
    pose = Pose((1.0, 2.0, 3.0), from_rpy(0.1, 0.2, 0.3))
    model = world.spawn(spec, 'ball', pose)
    assert model.pose.position == pytest.approx(pose.position)
    assert to_rpy(model.pose.orientation) == pytest.approx((0.1, 0.2, 0.3))


def test_the_velocity_is_that_of_the_link_origin(world):
    spec = free_ball(Inertial(1.0, Pose((1.0, 0.0, 0.0)), 0.1, 0.1, 0.1))
    model = world.spawn(spec, 'ball', Pose((0.0, 0.0, 5.0)))
    model.set_twist(Twist((0.1, 0.2, 0.3), (0.0, 0.0, 2.0)))
    assert model.twist.linear == pytest.approx((0.1, 0.2, 0.3))
    assert model.twist.angular == pytest.approx((0.0, 0.0, 2.0))


@pytest.mark.parametrize('moments', [(0.01, 0.01, 0.03), (1.0, 100.0, 1.0)])
def test_body_with_an_unphysical_tensor_rotates(world, moments):
    model = world.spawn(free_ball(Inertial(1.0, Pose(), *moments)), 'b', Pose((0, 0, 50.0)))
    model.set_twist(Twist((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    world.run(SECOND)
    assert to_rpy(model.pose.orientation)[2] == pytest.approx(1.0, abs=0.01)


def test_setting_the_pose_keeps_velocities_and_joints(world, robot):
    robot.joint('wheel_left_joint').set_position(0.7)
    world.run(100)
    falling = robot.twist.linear[2]
    robot.set_pose(Pose((3.0, 4.0, 2.0), from_rpy(0.0, 0.0, 1.0)))
    assert robot.pose.position == pytest.approx((3.0, 4.0, 2.0))
    assert robot.twist.linear[2] == pytest.approx(falling)
    assert robot.joint('wheel_left_joint').position == pytest.approx(0.7, abs=1e-3)


def test_a_passive_joint_swings_freely(world):
    spec = urdf_spec(ARM.format(type='continuous', motion=''))
    model = world.spawn(spec, 'arm', Pose())
    highest = 0.0
    for _ in range(40):
        world.run(50)
        highest = max(highest, model.joint('hinge').position)
    # From horizontal it swings to the other side: half a turn.
    assert highest == pytest.approx(math.pi, abs=0.05)


def test_joint_stays_within_its_limits(world):
    motion = '<limit lower="-0.5" upper="0.5" effort="10" velocity="10"/>'
    spec = urdf_spec(ARM.format(type='revolute', motion=motion))
    model = world.spawn(spec, 'arm', Pose())
    world.run(3 * SECOND)
    assert model.joint('hinge').position == pytest.approx(0.5, abs=0.01)


def test_a_model_whose_root_is_the_world_is_fixed_to_it_whatever_velocity_is_set(world):
    spec = urdf_spec(ARM.format(type='continuous', motion=''))
    model = world.spawn(spec, 'arm', Pose())
    world.run(SECOND)
    assert model.links['post'].pose.position == pytest.approx((0.0, 0.0, 2.0))
    model.set_twist(Twist((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    world.run(300)
    assert model.links['post'].pose.position == pytest.approx((0.0, 0.0, 2.0))


def test_joint_between_world_and_root_moves(world):
    gate = """<link name="world"/>
      <link name="gate"><inertial><origin xyz="0.5 0 0"/><mass value="1"/>
      <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
      <joint name="hinge" type="continuous"><parent link="world"/><child link="gate"/>
      <origin xyz="0 0 2"/><axis xyz="0 1 0"/></joint>"""
    model = world.spawn(urdf_spec(gate), 'gate', Pose((1.0, 0.0, 0.0)))
    world.run(300)
    assert model.links['gate'].pose.position == pytest.approx((1.0, 0.0, 2.0), abs=1e-6)
    assert model.joint('hinge').position > 0.3
    assert list(model.links) == ['gate']


def test_static_model_does_not_fall(world):
    spec = urdf_spec(box_urdf('1 1 1', 1.0, '<gazebo><static>true</static></gazebo>'))
    model = world.spawn(spec, 'box', Pose((0.0, 0.0, 3.0)))
    world.run(SECOND)
    assert model.pose.position == (0.0, 0.0, 3.0)


def test_files_of_a_submesh_are_removed_with_the_last_model(world):
    shape = (
        f'<geometry><mesh><uri>file://{ROOT}/meshes/wheel.dae</uri>'
        '<submesh><name>wheel</name><center>1</center></submesh></mesh></geometry>'
    )
    text = (
        f'<sdf version="1.6"><model name="m"><link name="l"><collision name="c">{shape}'
        f'</collision><visual name="v">{shape}</visual></link></model></sdf>'
    )
    for name in ('first', 'second'):
        spec, _ = load_sdf(text, name, find_model=ModelSearch())
        model = world.spawn(spec, name, SPAWN_POSE)
    world.run(10)
    folder = Path(str(model.spec.links[0].visuals[0].geometry.path)).parent
    del model, spec
    for name, left in (('first', 1), ('second', 0)):
        world.delete(name)
        gc.collect()  # models and links reference each other
        assert len(list(folder.iterdir())) == left


def test_a_link_without_gravity_floats(world):
    off = '<gazebo reference="box"><turnGravityOff>true</turnGravityOff></gazebo>'
    model = world.spawn(urdf_spec(box_urdf('1 1 1', 2.0, off)), 'box', Pose((0, 0, 3.0)))
    world.run(SECOND)
    assert model.pose.position[2] == pytest.approx(3.0, abs=1e-6)


@pytest.mark.parametrize(('mu', 'slides'), [(0.1, True), (0.3, False)])
def test_a_box_slides_on_a_slope_when_it_is_steeper_than_its_friction(world, mu, slides):
    slope = math.radians(10.0)  # the tangent is 0.176
    ramp = urdf_spec(box_urdf('20 20 0.2', 1.0, '<gazebo><static>true</static></gazebo>'))
    friction = f'<gazebo reference="box"><mu1>{mu}</mu1><mu2>{mu}</mu2></gazebo>'
    world.spawn(ramp, 'ramp', Pose((0.0, 0.0, 5.0), from_rpy(0.0, slope, 0.0)))
    box = world.spawn(
        urdf_spec(box_urdf('0.5 0.5 0.5', 1.0, friction)),
        'box',
        Pose((0.0, 0.0, 5.36), from_rpy(0.0, slope, 0.0)),
    )
    world.run(SECOND)
    start = box.pose.position[0]
    world.run(SECOND)
    way = box.pose.position[0] - start
    assert way > 0.5 if slides else abs(way) < 0.005


def test_collisions_of_one_link_may_differ_in_friction(world):
    # A sledge with a slippery runner; the rough load on top does not touch.
    sledge = (
        box_urdf('0.5 0.5 0.5', 1.0)
        + """
      <link name="skid"><collision><geometry><box size="0.5 0.5 0.1"/></geometry></collision></link>
      <joint name="j" type="fixed"><parent link="box"/><child link="skid"/>
        <origin xyz="0 0 -0.3"/></joint>
      <gazebo reference="skid"><mu1>0</mu1><mu2>0</mu2></gazebo>"""
    )
    model = world.spawn(urdf_spec(sledge), 'sledge', Pose((0.0, 0.0, 0.36)))
    world.run(200)
    model.set_twist(Twist((1.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    world.run(SECOND)
    assert model.twist.linear[0] == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize(
    ('depth', 'kp'), [(0.25, ''), (0.1, ''), (0.01, ''), (0.1, '1e5'), (0.1, '1e6'), (0.1, '1e9')]
)
def test_box_spawned_inside_the_ground_rises_without_a_jump(world, depth, kp):
    block = f'<gazebo reference="box"><kp>{kp}</kp><kd>100</kd><maxVel>0.1</maxVel></gazebo>'
    spec = urdf_spec(box_urdf('0.5 0.5 0.5', 2.0, block if kp else ''))
    box = world.spawn(spec, 'box', Pose((0, 0, 0.25 - depth)))
    highest = 0.0
    for _ in range(100):
        world.run(20)
        highest = max(highest, box.pose.position[2])
    assert highest < 0.25 + 0.15
    assert box.pose.position[2] == pytest.approx(0.25, abs=0.002)


def test_infinite_motor_speed_does_not_harm_the_world(world):
    witness = world.spawn(urdf_spec(box_urdf('1 1 1', 1.0)), 'box', Pose((5.0, 0.0, 0.5)))
    model = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
    world.run(SECOND)
    model.joint('wheel_left_joint').set_motor(math.inf, 5.0)
    world.run(SECOND)
    assert all(map(math.isfinite, model.pose.position))
    assert witness.pose.position == pytest.approx((5.0, 0.0, 0.5), abs=0.01)


def test_diverged_model_does_not_affect_the_others(world, caplog):
    witness = world.spawn(urdf_spec(box_urdf('1 1 1', 1.0)), 'witness', Pose((5, 0, 0.5)))
    mover = world.spawn(urdf_spec(box_urdf('1 1 1', 1.0)), 'mover', Pose((-5, 0, 0.5)))
    world.run(100)
    mover.set_twist(Twist((0.2, 0.0, 0.0), (0.0, 0.0, 0.0)))
    diverged = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
    diverged.set_twist(Twist((math.nan, 0.0, 0.0), (0.0, 0.0, 0.0)))
    world.run(2 * SECOND)
    assert witness.pose.position == pytest.approx((5.0, 0.0, 0.5), abs=0.06)
    assert diverged.pose.position[2] == pytest.approx(-0.12, abs=0.01)
    world.delete('rosbots')
    again = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
    world.run(2 * SECOND)
    assert again.pose.position[2] == pytest.approx(-0.12, abs=0.01)
    (line,) = [text for text in caplog.messages if 'diverged:' in text]
    assert line.startswith("model 'rosbots' diverged:")


def test_two_coincident_boxes_separate_slowly(world):
    spec = urdf_spec(box_urdf('0.5 0.5 0.5', 1.0))
    boxes = [world.spawn(spec, f'box{i}', Pose((0.1 * i, 0.0, 0.25))) for i in range(2)]
    fastest = 0.0
    for _ in range(150):
        world.run(20)
        fastest = max(fastest, *(abs(x) for box in boxes for x in box.twist.linear))
    assert fastest < 5.0
    assert math.dist(boxes[0].pose.position, boxes[1].pose.position) > 0.49


def test_stack_of_five_boxes_stands(world):
    spec = urdf_spec(box_urdf('0.5 0.5 0.5', 1.0))
    boxes = [world.spawn(spec, f'box{i}', Pose((0.0, 0.0, 0.25 + i / 2))) for i in range(5)]
    world.run(3 * SECOND)
    for i, box in enumerate(boxes):
        assert box.pose.position == pytest.approx((0.0, 0.0, 0.25 + i / 2), abs=0.01)


def test_obstacle_of_the_course_stands_stably(world):
    shape = '<origin xyz="2 0 1"/><geometry><box size="1 1 2"/></geometry>'
    obstacle = urdf_spec(f"""<link name="my_box"><inertial><origin xyz="2 0 0"/><mass value="1"/>
      <inertia ixx="1" iyy="100" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
      <collision>{shape}</collision><visual>{shape}</visual></link>""")
    model = world.spawn(obstacle, 'my_object', Pose((1.0, 0.0, 1.0)))
    world.run(5 * SECOND)
    assert model.pose.position == pytest.approx((1.0, 0.0, 0.0), abs=0.01)
    # It rocks: the nearest physical inertia is a hundred times that of such a box.
    assert max(map(abs, model.twist.linear)) < 0.05
