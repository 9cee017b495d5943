"""Divergence of any link is detected soon, and affects no other model."""

import math
from dataclasses import replace

import pytest
from support import box_urdf, empty_world, urdf_spec

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.core.transforms import Pose, Twist
from rosbots_description.sim.physics.bullet.client import pybullet
from rosbots_description.sim.runtime.divergence_watchdog import PERIOD

BOX = urdf_spec(box_urdf('1 1 1', 1.0))
CRANE = """<link name="world"/>
  <link name="arm"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="hook"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="slew" type="continuous"><parent link="world"/><child link="arm"/></joint>
  <joint name="swing" type="continuous"><parent link="arm"/><child link="hook"/>
  <origin xyz="1 0 0"/></joint>"""


def diverged(caplog):
    return [r.getMessage() for r in caplog.records if 'diverged:' in r.getMessage()]


@pytest.mark.parametrize('joint', ['slew', 'swing'])
@pytest.mark.parametrize('position', [math.nan, math.inf, 1e10])
def test_divergence_of_any_link_is_detected(world, caplog, joint, position):
    crane = world.spawn(urdf_spec(CRANE), 'crane', Pose((0.0, 0.0, 5.0)))
    world.run(10)
    crane.joint(joint).set_position(position)
    world.run(PERIOD)
    assert len(diverged(caplog)) == 1
    assert abs(crane.joint(joint).position) < 1.0


@pytest.mark.parametrize('step_size', [10.0, 0.5])
def test_models_are_checked_at_once_after_a_change_of_the_step_size(world, caplog, step_size):
    usual = world.physics
    world.run(PERIOD // 2)
    world.set_physics(replace(usual, step_size=step_size))
    box = world.spawn(BOX, 'box', Pose((0.0, 0.0, 0.5)))
    world.run(5)
    world.set_physics(usual)
    box.set_twist(Twist((math.nan, 0.0, 0.0), (0.0, 0.0, 0.0)))
    world.run(2)
    assert len(diverged(caplog)) == 1
    world.run(2 * PERIOD)
    assert box.pose.position == pytest.approx((0.0, 0.0, 0.5), abs=0.01)


@pytest.mark.parametrize(('first', 'then'), [(0.001, 0.004), (0.004, 0.0005)])
def test_soft_contacts_do_not_depend_on_when_the_step_size_was_set(first, then):
    surface = '<gazebo reference="box"><kp>20000</kp><kd>10</kd></gazebo>'
    spec = urdf_spec(box_urdf('0.2 0.2 0.2', 1.0, surface))

    def dropped(early):
        with empty_world() as world:
            world.set_physics(replace(world.physics, step_size=then if early else first))
            box = world.spawn(spec, 'box', Pose((0.0, 0.0, 0.3)))
            world.set_physics(replace(world.physics, step_size=then))
            info = pybullet.getDynamicsInfo(box.body.bodies[0], -1, world.engine._client)
            world.run(round(0.5 / then))
            return info, box.state()

    assert dropped(early=True) == dropped(early=False)


@pytest.mark.parametrize(
    'lose',
    [
        lambda model: model.set_pose(Pose((1e308, 0.0, 0.5))),
        lambda model: model.set_twist(Twist((1e308, 0.0, 0.0), (0.0, 0.0, 0.0))),
    ],
)
def test_diverged_model_deleted_before_its_detection_affects_no_other(world, lose):
    neighbour = world.spawn(BOX, 'neighbour', Pose((5.0, 0.0, 0.5)))
    diverged = world.spawn(BOX, 'diverged', Pose((0.0, 0.0, 0.5)))
    lose(diverged)
    world.run(3)
    world.delete('diverged')
    world.run(500)
    assert neighbour.state()[0].position == pytest.approx((5.0, 0.0, 0.5), abs=1e-3)


@pytest.mark.parametrize('x', [1e9, -1e308, float('inf'), float('nan')])
def test_spawn_at_an_extreme_position_is_rejected(world, x):
    with pytest.raises(ModelError, match='m away; less than 1e'):
        world.spawn(BOX, 'far', Pose((x, 0.0, 0.5)))
    assert 'far' not in world.models
