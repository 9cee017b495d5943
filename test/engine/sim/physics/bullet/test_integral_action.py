"""Motors of robots reach their speed by integral action: no overshoot, no ringing."""

import itertools
import math
from dataclasses import replace

import pytest
from support import urdf_spec
from support.scenes import box, castered, spec_height, tilted_floor, wheel

from rosbots_description.sim.core.transforms import Pose, compose
from rosbots_description.sim.description.physics_settings import PhysicsSettings
from rosbots_description.sim.physics.bullet.client import pybullet
from rosbots_description.sim.physics.bullet.integral_action import PERIOD

OVERSHOOT = 0.03  # share of the target
SLOPE = math.radians(20.0)
MIDDLE = castered(casters=1)


def spawned(world, spec, pitch=0.0, height=0.0):
    """Return the robot after half a second, facing up a slope [rad] or on the ground."""
    pose = Pose((0.0, 0.0, spec_height(spec) + height))
    if pitch:
        pose = compose(tilted_floor(world, pitch=-pitch), pose)
    model = world.spawn(spec, 'robot', pose)
    world.run(round(0.5 / world.engine._physics.step_size))
    return model


def block(world):
    """Put a wall in front of the robot."""
    wall = replace(urdf_spec(box('wall', (0.1, 2.0, 1.0), 1.0)), static=True)
    world.spawn(wall, 'wall', Pose((0.35, 0.0, 0.5)))


def command(model, forward, turning=0.0):
    next(iter(model.plugins.values())).command(forward, turning)


def excesses(world, model, target, steps):
    """Return the speeds of the wheels relative to their target, less 1, after each step."""
    found = []
    for _ in range(steps):
        world.run(1)
        found.append(max(joint.velocity / target - 1.0 for joint in model.joints.values()))
    return found


@pytest.mark.parametrize('step', [0.0005, 0.001, 0.004, 0.01])
@pytest.mark.parametrize(
    ('mass', 'size'), [(0.05, 0.08), (0.2, 0.12), (1.0, 0.2), (5.0, 0.4), (50.0, 1.0), (500.0, 4.0)]
)
def test_wheels_of_0_02_to_1_m_reach_their_speed_without_overshoot(world, mass, size, step):
    world.set_physics(PhysicsSettings(step_size=step))
    model = spawned(world, castered(mass, size, casters=1))
    speed = min(1.0, 2.0 * size)
    command(model, speed)
    world.run(round((speed + 0.05) / step))  # the ramp
    found = excesses(world, model, speed / (size / 4.0), 30 * PERIOD)
    assert max(found) < OVERSHOOT
    assert max(map(abs, found[20 * PERIOD :])) < 0.005


@pytest.mark.parametrize('pitch', [SLOPE, -SLOPE])
@pytest.mark.parametrize(('mass', 'size'), [(0.05, 0.08), (1.0, 0.2), (50.0, 1.0), (500.0, 4.0)])
def test_on_a_slope_they_reach_it_too(world, mass, size, pitch):
    """Light robots hop: their wheels are 5 % too fast for 0.1 s at most, for 0.02 s unaided."""
    model = spawned(world, castered(mass, size, casters=1), pitch)
    speed = min(1.0, 2.0 * size)
    command(model, speed)
    world.run(round(1000 * (speed + 0.5)))
    found = excesses(world, model, speed / (size / 4.0), 2000)
    assert sum(one > OVERSHOOT for one in found) <= 100
    assert max(found) < 2.0 * OVERSHOOT
    assert abs(sum(found[1000:])) / 1000 < 0.005


def test_the_solver_makes_as_many_iterations_at_each_command(world):
    model = spawned(world, MIDDLE)
    for forward, turning in ((0.0, 0.0), (0.01, 0.0), (0.0, 0.1), (1.0, -1.0)):
        command(model, forward, turning)
        world.run(500)
        settings = pybullet.getPhysicsEngineParameters(world.engine._client)
        assert settings['numSolverIterations'] == 10


def test_a_stalled_robot_that_is_set_free_is_too_fast_for_a_period_at_most(world):
    model = spawned(world, MIDDLE)
    block(world)
    command(model, 0.2)
    world.run(3000)
    assert abs(model.twist.linear[0]) < 0.01
    world.delete('wall')
    world.run(2 * PERIOD)
    assert max(excesses(world, model, 2.0, 2000)) < OVERSHOOT
    assert model.twist.linear[0] == pytest.approx(0.2, rel=0.01)


def test_a_command_that_flips_each_tenth_of_a_second_leaves_no_trace(world):
    model = spawned(world, castered(1.0, 0.2, casters=1, acceleration=0.0))
    for sign in (1.0, -1.0) * 20:
        command(model, sign * 0.1)
        world.run(100)
        speeds = [joint.velocity for joint in model.joints.values()]
        assert speeds == pytest.approx([sign * 2.0] * 2, rel=0.2)
    command(model, 0.1)
    world.run(500)
    assert max(map(abs, excesses(world, model, 2.0, 1000))) < 0.01


def test_a_robot_that_is_lifted_and_put_down_goes_on(world):
    model = spawned(world, MIDDLE)
    command(model, 0.3)
    world.run(2000)
    for height in (0.5, 0.0):
        place = model.pose.position
        model.set_pose(Pose((place[0], place[1], spec_height(MIDDLE) + height)))
        world.run(2 * PERIOD)
        found = excesses(world, model, 3.0, 200 if height else 2000)
        assert max(found[-1000:]) < OVERSHOOT
    assert model.twist.linear[0] == pytest.approx(0.3, rel=0.01)


def test_two_motors_on_one_axle_both_reach_their_speeds(world):
    shaft = wheel('shaft', 'inner', 0.05, 0.3, 0.2, '0 0 0.5')
    disc = wheel('disc', 'outer', 0.1, 0.05, 1.0, '0 0 0').replace(
        '<parent link="base"/>', '<parent link="shaft"/>'
    )
    disc = disc.replace(f'rpy="{-math.pi / 2} 0 0"/><axis', '/><axis')
    model = world.spawn(
        urdf_spec(box('base', (1.0, 1.0, 0.2), 50.0) + shaft + disc), 'robot', Pose((0.0, 0.0, 0.1))
    )
    for first, second in itertools.permutations((2.0, -3.0, 0.1), 2):
        model.joint('inner').set_motor(first, 20.0)
        model.joint('outer').set_motor(second, 20.0)
        world.run(1000)
        for name, target in (('inner', first), ('outer', second)):
            assert model.joint(name).velocity == pytest.approx(target, abs=1e-3)


def test_a_robot_that_pushes_against_a_wall_does_not_wind_up_without_bound(world):
    model = spawned(world, castered(casters=1, torque=1e6))
    block(world)
    command(model, 0.2)
    world.run(5000)  # a clamp is reached in 0.1 s
    assert all(abs(one.offset) <= 0.15 * 2.0 + 1.0 for one in model.body.integrals.values())
