"""What the engine's settings were chosen for: robots and things that are not the article's."""

import math
from dataclasses import replace

import pytest
from support import empty_world, urdf_spec
from support.scenes import GRAVITY, SCENES, SPEED, box, castered, drive, forward_speed, link

from rosbots_description.sim.pose import Pose, Twist, add, dot, from_rpy, yaw_of

# The largest error of each scene, in its unit; measured ones are in doc/physics.md.
BOUNDS = {
    'one dragging caster': 0.002,
    'two casters, mu 1': 0.01,
    'two casters, mu 0.1': 0.002,
    '50 kg': 0.002,
    '0.2 kg': 0.002,
    'speed, any heading': 0.005,
    'curve, laden caster': 0.01,
    'sharp, laden caster': 0.4,
    'curve, 0.2 kg': 0.01,
    'veer, one caster': 0.002,
    'veer, laden caster': 0.002,
    'veer, two casters': 0.002,
    'veer, backs at once': 0.002,
    'veer, tips over': 0.01,
    'veer, on its nose': 0.01,
    'veer, 0.2 kg': 0.002,
    'veer, broad wheels': 0.002,
    'veer, weak motors': 0.002,
    "veer, the article's": 0.005,
    'skid steer straight': 0.002,
    'step of 3 cm [m]': 0.0,
    'parked on casters [m]': 1e-4,
    'parked on wheels [m]': 3e-4,
    'slides on 10 deg': 1e-3,
    'five boxes [m]': 1e-3,
    'half sunk box [m]': 0.15,
    'ball rolls': 1e-3,
    'can lies [m]': 1e-3,
}
SKID_TURNS = (0.5, 1.0)  # share of the rate without slip


def test_every_scene_is_looked_at():
    assert set(SCENES) == {*BOUNDS, 'skid steer turns'}


@pytest.mark.parametrize('name', BOUNDS)
def test_mechanics_is_obeyed(name):
    assert SCENES[name]() <= BOUNDS[name]


def test_a_skid_steer_turns_though_its_wheels_slip():
    least, most = SKID_TURNS
    assert least < SCENES['skid steer turns']() < most


@pytest.mark.parametrize(('mass', 'size'), [(0.2, 0.12), (5.0, 0.4), (50.0, 1.0)])
def test_wheels_to_both_sides_carry_the_same(mass, size):
    with empty_world() as world:
        model = drive(world, castered(mass, size, casters=1, rear=0.4), 1, speed=0.0)
        left, right = (model.joint(f'{side}_joint').normal_force() for side in ('left', 'right'))
        assert left == pytest.approx(right, rel=1e-4)
        assert left > 0.3 * mass * GRAVITY


@pytest.mark.parametrize(('mass', 'size', 'speed'), [(0.2, 0.12, 0.5), (5.0, 0.4, 1.0)])
def test_wheels_that_spin_as_they_set_off_do_not_turn_a_robot(mass, size, speed):
    spec = castered(mass, size, casters=1, acceleration=0.0, rear=0.4)
    with empty_world() as world:
        model = drive(world, spec, 2, speed=speed)
        assert yaw_of(model.pose.orientation) == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize('speed', [0.5, -0.5])
def test_what_the_solver_leaves_undone_turns_no_light_robot(speed):
    with empty_world() as world:
        model = drive(world, castered(0.2, 0.12, casters=1, rear=0.4), 6, math.pi / 4.0, speed)
        assert yaw_of(model.pose.orientation) == pytest.approx(math.pi / 4.0, abs=3e-3)


@pytest.mark.parametrize('heading', [-1.2, -0.8, 0.3, 1.1])
@pytest.mark.parametrize('speed', [0.5, 1.0, -1.0])
@pytest.mark.parametrize('spec', [castered(), castered(0.2, 0.12)], ids=['5 kg', '0.2 kg'])
def test_who_stands_on_four_points_sets_off_straight_on(spec, speed, heading):
    with empty_world() as world:
        model = drive(world, spec, 2, heading, speed)
        assert yaw_of(model.pose.orientation) == pytest.approx(heading, abs=0.01)
        assert forward_speed(model) == pytest.approx(speed, rel=0.01)


@pytest.mark.parametrize('heading', [0.2, 0.6, 1.2])
@pytest.mark.parametrize(('speed', 'robot'), [
    (1.0, {'casters': 1, 'rear': 0.2}),
    (1.0, {'casters': 1, 'rear': 0.4}),
    (-1.0, {}),
    (0.3, {'mass': 0.2, 'size': 0.12, 'casters': 1}),
])
def test_wheels_that_spin_as_they_set_off_do_not_turn_the_robot(speed, robot, heading):
    with empty_world() as world:
        model = drive(world, castered(acceleration=0.0, **robot), 2, heading, speed)
        assert yaw_of(model.pose.orientation) == pytest.approx(heading, abs=0.02)
        assert forward_speed(model) == pytest.approx(speed, rel=0.1)


@pytest.mark.parametrize('heading', [0.0, 0.4, math.pi / 4.0, 1.3, -2.0])
@pytest.mark.parametrize('aside', [0.05, -0.3])
def test_tyres_that_spin_bring_a_slip_to_its_end_without_turning_it(heading, aside):
    with empty_world() as world:
        model = drive(world, castered(acceleration=0.0, mu=0.0), 0, heading, 1.0)
        world.run(20)
        ahead = (math.cos(heading), math.sin(heading), 0.0)
        left = (-ahead[1], ahead[0], 0.0)
        before = model.twist.linear
        moved = add(before, tuple(aside * part for part in left))
        world.engine.set_root_twist(model.body, 'base', Twist(moved))
        world.run(60)
        after = model.twist.linear
        shrunk = (1.0 - dot(after, ahead)) / (1.0 - dot(before, ahead))
        assert 0.5 < shrunk < 0.7
        assert dot(after, left) == pytest.approx(aside * shrunk, rel=0.1)
        assert yaw_of(model.pose.orientation) == pytest.approx(heading, abs=0.01)


@pytest.mark.parametrize('heading', [0.0, 0.4, 1.0])
def test_a_robot_that_its_motors_cannot_move_does_not_turn(heading):
    with empty_world() as world:
        stuck = castered(casters=1, torque=0.05, rear=0.3)
        model = drive(world, stuck, 20, heading)
        assert yaw_of(model.pose.orientation) == pytest.approx(heading, abs=0.02)
        assert math.hypot(*model.pose.position[:2]) < 0.01


@pytest.mark.parametrize('heading', [0.2, 1.2])
@pytest.mark.parametrize(('torque', 'rear'), [(0.132, 0.3), (0.172, 0.4)])
def test_a_robot_that_its_motors_can_just_move_does_not_turn(torque, rear, heading):
    with empty_world() as world:
        model = drive(world, castered(casters=1, torque=torque, rear=rear), 20, heading)
        assert yaw_of(model.pose.orientation) == pytest.approx(heading, abs=0.02)
        assert math.hypot(*model.pose.position[:2]) > 1.0


def test_two_casters_drive_on_a_floor_that_is_no_plane():
    with empty_world() as world:
        world.delete('ground_plane')
        slab = replace(urdf_spec(box('slab', (40.0, 40.0, 1.0), 1.0)), static=True)
        world.spawn(slab, 'slab', Pose((0.0, 0.0, -0.5)))
        model = drive(world, castered(), 4, 0.4)
        assert yaw_of(model.pose.orientation) == pytest.approx(0.4, abs=0.01)
        assert forward_speed(model) == pytest.approx(SPEED, rel=0.01)


def speeds_of_a_can(free):
    """Return how fast a can rolls 1, 2 and 3 s after it was sliding at 1 m/s; `free`: let to."""
    can = urdf_spec(link('can', '<cylinder radius="0.1" length="0.2"/>', 1.0, (6e-3, 6e-3, 5e-3)))
    with empty_world() as world:
        model = world.spawn(can, 'can', Pose((0.0, 0.0, 0.1), from_rpy(math.pi / 2.0, 0.0, 0.0)))
        if free:
            world.engine.let_roll(model.body, 'can')
        world.run(100)
        model.set_twist(Twist((1.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
        speeds = []
        for _ in range(3):
            world.run(1000)
            speeds.append(model.twist.linear[0])
    return speeds


def test_a_can_that_is_pushed_rolls_and_slowly_stops():
    first, second, third = speeds_of_a_can(free=False)
    assert 0.6 < first < 2.0 / 3.0
    assert 0.02 < first - second < 0.05
    assert second - third == pytest.approx(first - second, rel=0.2)


def test_what_a_motor_turns_is_not_held_back():
    assert min(speeds_of_a_can(free=True)) > 0.66
