"""Mass and friction are multiplied in a running world, and restored with its state."""

import math

import pytest
from support import box_urdf

from rosbots_description.sim import PhysicsSettings, World

SLED = f'<robot name="sled">{box_urdf("1 1 0.2", 2.0)}</robot>'
PENDULUM = """<robot name="pendulum"><link name="world"/><link name="rod"><inertial>
<origin xyz="0 0 -1"/><mass value="2"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="hinge" type="revolute"><parent link="world"/><child link="rod"/><axis xyz="0 1 0"/>
<limit lower="-3" upper="3" effort="100" velocity="100"/><dynamics damping="0" friction="0"/>
</joint><gazebo reference="hinge"><springStiffness>80</springStiffness></gazebo></robot>"""


def pushed(factor, force=10.0):
    """Return the speed of a sled after half a second of a force, in weightlessness [m/s]."""
    with World(PhysicsSettings(gravity=(0.0, 0.0, 0.0))) as world:
        sled = world.spawn(SLED)
        sled.scale_mass(factor)
        assert sled.mass_scale == factor
        world.apply_wrench(sled.link('box'), (force, 0.0, 0.0), (0.0, 0.0, force), seconds=0.499)
        world.run(seconds=0.6)
        return sled.twist


def slid(factor):
    """Return how far a sled of mu 1 slides on the ground from 2 m/s [m]."""
    with World.empty() as world:
        sled = world.spawn(SLED, z=0.1)
        world.run(seconds=0.5)
        sled.link('box').scale_friction(factor)
        sled.set_twist(sled.twist._replace(linear=(2.0, 0.0, 0.0)))
        world.run(seconds=3.0)
        return sled.pose.position[0]


def test_acceleration_is_inverse_to_mass_and_moments():
    once, thrice = pushed(1.0), pushed(3.0)
    assert once.linear[0] == pytest.approx(2.5, rel=0.01)  # F t / m
    assert once.linear[0] / thrice.linear[0] == pytest.approx(3.0, rel=1e-6)
    assert once.angular[2] / thrice.angular[2] == pytest.approx(3.0, rel=1e-6)


@pytest.mark.parametrize('factor', [0.3, 1.0, 2.0])
def test_sliding_distance_is_inverse_to_friction(factor):
    assert slid(factor) == pytest.approx(2.0**2 / (2.0 * 9.8 * factor), rel=0.1)


def test_heavier_pendulum_on_a_spring_swings_slower():
    def zero_crossing(factor):
        with World(PhysicsSettings(gravity=(0.0, 0.0, 0.0))) as world:
            rod = world.spawn(PENDULUM)
            rod.scale_mass(factor)
            hinge = rod.joint('hinge')
            hinge.set_position(0.3)
            while hinge.position > 0.0:
                world.step()
            return world.time

    assert zero_crossing(4.0) / zero_crossing(1.0) == pytest.approx(2.0, rel=0.02)


def test_scales_outlast_a_reset_and_a_rebuild_and_are_restored(world):
    sled = world.spawn(SLED, z=0.1)
    link = sled.link('box')
    world.run(seconds=0.2)
    start = world.save_state()
    sled.scale_mass(2.0)
    link.scale_friction(0.5)
    changed = world.save_state()
    world.restore(start)
    assert (sled.mass_scale, link.friction_scale) == (1.0, 1.0)
    world.restore(changed)
    assert (sled.mass_scale, link.friction_scale) == (2.0, 0.5)
    world.reset_simulation()
    assert (sled.mass_scale, link.friction_scale) == (2.0, 0.5)
    world.rebuild([])
    assert (sled.mass_scale, link.friction_scale) == (2.0, 0.5)
    sled.respecify(sled.spec)
    assert (sled.mass_scale, link.friction_scale) == (2.0, 0.5)


@pytest.mark.parametrize('factor', [-1.0, math.nan, math.inf])
def test_factor_that_cannot_be_is_named(world, factor):
    sled = world.spawn(SLED)
    with pytest.raises(ValueError, match="mass of model 'sled'"):
        sled.scale_mass(factor)
    with pytest.raises(ValueError, match="friction of link 'sled::box'"):
        sled.link('box').scale_friction(factor)
