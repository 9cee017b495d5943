"""A robot of many shapes stands, falls and touches as any other."""

import math
from dataclasses import replace
from itertools import product

import pytest
from support import empty_world, robot_spec, urdf_spec
from support.scenes import ball, box, wheel

from rosbots_description.sim.core.transforms import Pose, Twist, compose, from_rpy

CORNERS = list(product((-0.2, 0.2), (-0.15, 0.15), (0.145, 0.355)))  # of the plates [m]


def robot(ixz):
    """Return a robot of two plates, eight posts between them, two wheels and a sphere below.

    Args:
        ixz: product of inertia [kg m^2] that turns its principal axes.
    """
    shapes = [(f'0 0 {z}', '<box size="0.4 0.3 0.01"/>') for z in (0.15, 0.35)]
    shapes += [('-0.15 0 0.07', '<sphere radius="0.07"/>')]
    shapes += [
        (f'{x} {y} 0.25', '<cylinder radius="0.02" length="0.18"/>')
        for x in (-0.15, -0.05, 0.05, 0.15)
        for y in (-0.1, 0.1)
    ]
    collisions = ''.join(
        f'<collision><origin xyz="{at}"/><geometry>{shape}</geometry></collision>'
        for at, shape in shapes
    )
    body = (
        f'<link name="base"><inertial><origin xyz="0 0 0.15"/><mass value="5"/><inertia '
        f'ixx="0.1" iyy="0.12" izz="0.15" ixy="0" ixz="{ixz}" iyz="0"/></inertial>'
        f'{collisions}</link>'
    )
    for side, y in (('left', 0.2), ('right', -0.2)):
        body += wheel(side, f'{side}_joint', 0.1, 0.04, 0.5, f'0.1 {y} 0.1')
    return urdf_spec(body)


@pytest.fixture(params=[0.0, 0.02], ids=['straight', 'askew'])
def spec(request):
    return robot(request.param)


@pytest.fixture
def standing(world, spec):
    """Return the robot after half a second on the ground."""
    model = world.spawn(spec, 'robot', Pose((0.0, 0.0, 0.001)))
    world.run(500)
    return model


def corners(model):
    """Return the corners of the plates in the world frame [m]."""
    return [compose(model.pose, Pose(corner)).position for corner in CORNERS]


def test_robot_with_occluded_posts_stands(world, standing):
    world.run(1500)
    assert standing.pose.position == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)


@pytest.mark.parametrize('roll', [math.pi / 2.0, math.pi])
def test_overturned_robot_lies_on_its_plates(world, spec, roll):
    model = world.spawn(spec, 'robot', Pose((0.0, 0.0, 0.5), from_rpy(roll, 0.0, 0.0)))
    world.run(4000)
    assert min(z for _, _, z in corners(model)) == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize(
    ('height', 'turn'),
    [
        (0.5, (0.0, 0.0, 0.0)),
        (2.0, (0.0, -0.8, 0.0)),
        (2.0, (-2.73, -3.06, 2.12)),
    ],
)
def test_contacts_are_found_before_it_hits_the_floor(world, height, turn):
    model = world.spawn(robot_spec(), 'robot', Pose((0.0, 0.0, height), from_rpy(*turn)))
    deepest = 0.0
    for _ in range(900):
        world.run(1)
        depths = [contact.depth for contact in world.engine.contacts(model.body)]
        deepest = max([deepest, *depths])
    assert 1e-4 < deepest < 9e-4  # [m]; 2 to 5 mm if each were found in the step after


def test_robot_stands_on_a_floor_spawned_later(world, spec):
    ground = world.models['ground_plane'].spec
    world.delete('ground_plane')
    model = world.spawn(spec, 'robot', Pose((0.0, 0.0, 0.001)))
    world.spawn(ground, 'ground_plane', Pose())
    world.run(2000)
    assert model.pose.position[2] == pytest.approx(0.0, abs=1e-3)


@pytest.mark.usefixtures('standing')
def test_body_flying_between_the_plates_hits_a_post(world):
    model = world.spawn(urdf_spec(ball('ball', 0.03, 0.1)), 'ball', Pose((-0.3, 0.1, 0.25)))
    model.set_twist(Twist((5.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    world.run(60)
    assert model.pose.position[0] < -0.15


def test_static_body_between_the_plates_hits_a_post(world, standing):
    pole = replace(urdf_spec(box('pole', (0.02, 0.02, 0.1), 1.0)), static=True)
    world.spawn(pole, 'pole', Pose((0.1, 0.1, 0.25)))
    standing.set_twist(Twist((-1.0, 0.0, 0.0)))
    world.run(300)
    assert standing.pose.position[0] > -0.05


def test_spawn_and_deletion_of_another_robot_keep_existing_contacts(spec):
    def driven(disturbed):
        with empty_world() as world:
            model = world.spawn(spec, 'robot', Pose((0.0, 0.0, 0.001)))
            for joint in model.joints.values():
                joint.set_motor(3.0, 5.0)
            world.run(500)
            if disturbed:
                world.spawn(spec, 'another', Pose((0.0, 5.0, 0.001)))
            world.run(500)
            if disturbed:
                world.delete('another')
            world.run(500)
            return model.state()

    assert driven(disturbed=True) == driven(disturbed=False)
