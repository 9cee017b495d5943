"""Contacts by the names of the description, and joint reactions."""

import math

import numpy as np
import pytest
from support import box_urdf, urdf_spec
from support.scenes import link

from rosbots_description.sim.core.transforms import Pose, Twist
from rosbots_description.sim.physics.bullet.contacts import _to_triangles

WEIGHT = 9.8
TWO = (
    '<link name="body"><inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" '
    'ixz="0" iyz="0"/></inertial>'
    '<collision name="ball"><origin xyz="0.5 0 0"/><geometry><sphere radius="0.1"/></geometry>'
    '</collision>'
    '<collision name="can"><origin xyz="-0.5 0.3 0"/><geometry>'
    '<cylinder radius="0.1" length="0.2"/></geometry></collision>'
    '<collision name="crate"><origin xyz="-0.5 -0.3 0"/><geometry><box size="0.2 0.2 0.2"/>'
    '</geometry></collision></link>'
)
LIFTED = link('base', '<box size="1 1 0.2"/>', 2.0, (0.1, 0.1, 0.1)) + (
    '<link name="arm"><inertial><origin xyz="0.3 0.1 0" rpy="0.3 0.2 0.9"/>'
    '<mass value="0.5"/><inertia ixx="0.01" iyy="0.02" izz="0.025" ixy="0" ixz="0" iyz="0"/>'
    '</inertial></link><joint name="shoulder" type="revolute"><parent link="base"/>'
    '<child link="arm"/><origin xyz="0 0 0.5" rpy="0 0 0.7"/><axis xyz="0 1 0"/>'
    '<limit lower="-3" upper="3" effort="9" velocity="9"/></joint>'
)


def total(contacts):
    return np.sum([contact.force for contact in contacts], axis=0)


def names(side):
    return side.link, side.collision


def test_contacts_name_the_collisions_and_balance_the_weight(world):
    thing = world.spawn(urdf_spec(TWO), 'thing', Pose((0.0, 0.0, 0.1)))
    world.run(1500)
    ground = world.models['ground_plane']
    contacts = world.engine.contacts(thing.body)
    # Collisions of a URDF are named as by sdformat.
    of = {
        name: [c for c in contacts if name in c.one.collision]
        for name in thing.links['body'].collisions
    }
    assert len(of) == 3
    assert all(of.values())
    assert sum(map(len, of.values())) == len(contacts)
    for collision, mine in of.items():
        place = thing.links['body'].collisions[collision].pose.position
        for contact in mine:
            assert math.dist(contact.position[:2], place[:2]) < 0.15
            assert contact.normal == pytest.approx((0.0, 0.0, 1.0))
            assert abs(contact.depth) < 1e-3
            assert (contact.one.body, contact.other.body) == (thing.body, ground.body)
    assert total(contacts) == pytest.approx((0.0, 0.0, WEIGHT), abs=0.02 * WEIGHT)
    below = world.engine.contacts(ground.body)
    assert {names(contact.other) for contact in below} == {names(c.one) for c in contacts}
    assert total(below) == pytest.approx(-total(contacts), abs=1e-9)
    assert below[0].normal == pytest.approx((0.0, 0.0, -1.0))
    everywhere = world.engine.contacts()
    assert sorted(c.position for c in everywhere) == sorted(c.position for c in contacts)


@pytest.mark.parametrize(
    ('point', 'distance'),
    [
        ((1.0, 1.0, 0.5), 0.5),  # above the triangle
        ((1.0, 2.0, -0.5), 0.5),  # below it
        ((2.0, -1.0, 0.0), 1.0),  # beside an edge
        ((3.0, 3.0, 0.0), math.sqrt(2.0)),  # beside the oblique edge
        ((-3.0, -4.0, 0.0), 5.0),  # off a corner
        ((9.0, 1.0, 1.0), 1.0),  # above the other triangle
    ],
)
def test_distance_to_a_mesh_is_that_to_its_nearest_triangle(point, distance):
    triangle = np.array([(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0)])
    triangles = np.array([triangle, np.add(triangle, (8.0, 0.0, 0.0))])
    assert _to_triangles(triangles, np.array(point)) == pytest.approx(distance)


def test_wheels_and_caster_of_the_robot_carry_its_weight(world, robot):
    world.run(2500)
    contacts = world.engine.contacts(robot.body)
    mass = sum(link.spec.inertial.mass for link in robot.links.values())
    assert total(contacts)[2] == pytest.approx(mass * WEIGHT, rel=0.02)
    known = {(link.name, name) for link in robot.links.values() for name in link.collisions}
    found = {names(contact.one) for contact in contacts}
    assert found <= known
    assert ('wheel_left_link', 'wheel_left_link_collision') in found
    assert any('caster' in collision for _, collision in found)
    left = world.engine.contacts(robot.body, 'wheel_left_link')
    assert {contact.one.link for contact in left} == {'wheel_left_link'}


@pytest.mark.parametrize('shape', ['box', 'sphere'])
def test_friction_opposes_sliding(world, shape):
    urdf = box_urdf('0.2 0.2 0.2', 1.0)
    if shape == 'sphere':
        urdf = urdf.replace('<box size="0.2 0.2 0.2"/>', '<sphere radius="0.1"/>')
    thing = world.spawn(urdf_spec(urdf), 'thing', Pose((0.0, 0.0, 0.1)))
    world.run(100)
    thing.set_twist(Twist((2.0, 0.0, 0.0)))
    world.run(20)
    ground = world.models['ground_plane'].body
    assert total(world.engine.contacts(thing.body))[0] == pytest.approx(-WEIGHT, rel=0.02)
    assert total(world.engine.contacts(ground))[0] == pytest.approx(WEIGHT, rel=0.02)


def test_touching_links_of_a_model_give_one_contact(world):
    legs = ''.join(
        link(name, '<sphere radius="0.2"/>', 1.0, (0.1, 0.1, 0.1))
        + f'<gazebo reference="{name}"><selfCollide>1</selfCollide></gazebo>'
        f'<joint name="{name}" type="prismatic"><parent link="base"/><child link="{name}"/>'
        f'<origin xyz="{x} 0 0"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="9" '
        'velocity="1"/></joint>'
        for name, x in (('a', -0.3), ('b', 0.3))
    )
    base = link('base', '<box size="0.01 0.01 0.01"/>', 1.0, (1.0, 1.0, 1.0))
    spec = urdf_spec(base + legs)
    pair = world.spawn(spec, 'pair', Pose((0.0, 0.0, 5.0)))
    pair.joints['a'].set_motor(1.0, 20.0)
    pair.joints['b'].set_motor(-1.0, 20.0)
    world.run(400)
    (contact,) = world.engine.contacts(pair.body)
    (mirrored,) = world.engine.contacts(pair.body, contact.other.link)
    assert {contact.one.link, contact.other.link} == {'a', 'b'}
    assert mirrored.one == contact.other
    assert mirrored.force == pytest.approx([-x for x in contact.force])


@pytest.mark.parametrize('lift', [0.0, 2.0])
def test_joint_reaction_balances_the_child(world, lift):
    model = world.spawn(urdf_spec(LIFTED), 'model', Pose((0.0, 0.0, 0.1 + lift)))
    model.joints['shoulder'].set_motor(0.0, 9.0)
    engine, body = world.engine, model.body
    engine.step(5)
    assert engine.joint_reaction(body, 'shoulder').force == (0.0, 0.0, 0.0)
    engine.measure_reaction(body, 'shoulder')
    engine.step(300)
    force, torque = engine.joint_reaction(body, 'shoulder')
    if lift:  # in free fall the reaction is zero
        assert (*force, *torque) == pytest.approx((0.0,) * 6, abs=1e-3)
        return
    weight = 0.5 * WEIGHT
    assert force == pytest.approx((0.0, 0.0, weight), abs=1e-3 * weight)
    # r x F about the joint, r = (0.3, 0.1, 0)
    assert torque == pytest.approx((0.1 * weight, -0.3 * weight, 0.0), abs=2e-3)
    assert torque[1] == pytest.approx(engine.joint_state(body, 'shoulder').effort, abs=2e-3)
    engine.measure_reaction(body, 'shoulder', wanted=False)
    engine.step(1)
    assert engine.joint_reaction(body, 'shoulder').force == (0.0, 0.0, 0.0)


def test_reaction_of_a_wheel_joint_is_its_load(world, robot):
    joint = next(j for j in robot.joints.values() if j.spec.child == 'wheel_left_link')
    world.engine.measure_reaction(robot.body, joint.name)
    world.run(2500)
    wheel = robot.links['wheel_left_link']
    load = total(world.engine.contacts(robot.body, wheel.name))[2]
    own = wheel.spec.inertial.mass * WEIGHT
    force = world.engine.joint_reaction(robot.body, joint.name).force
    assert math.hypot(*force) == pytest.approx(load - own, rel=0.02)
