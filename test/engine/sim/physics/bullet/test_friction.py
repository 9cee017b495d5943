"""Friction of a pair of surfaces is limited by the lesser coefficient."""

import math
from dataclasses import replace

import pytest
from support import box_urdf, empty_world, urdf_spec
from support.scenes import ball

from rosbots_description.sim.core.transforms import ZERO, Pose, Twist, compose, from_rpy
from rosbots_description.sim.physics.bullet.client import pybullet
from rosbots_description.sim.physics.bullet.friction_pairs import FrictionPairs, Kind, Role, Side

SECOND = 1000  # steps
GRAVITY = 9.8


def rough(mu, size='0.4 0.4 0.1', mass=1.0, static=False):
    """Return a box with a friction coefficient."""
    surface = f'<gazebo reference="box"><mu1>{mu}</mu1><mu2>{mu}</mu2></gazebo>'
    x, y, z = (float(length) ** 2 * mass / 12.0 for length in size.split())
    inertia = f'<inertia ixx="{y + z}" iyy="{x + z}" izz="{x + y}" '
    text = box_urdf(size, mass, surface).replace('<inertia ixx="0.1" iyy="0.1" izz="0.1" ', inertia)
    return replace(urdf_spec(text), static=static)


def push(world, boxes, force, steps):
    """Push boxes along x [N] for some steps."""
    for _ in range(steps):
        for box in boxes:
            box.links['box'].apply_wrench((force, 0.0, 0.0), ZERO)
        world.run(1)


def acceleration_down(slope, mu_box, mu_ramp, steps=SECOND):
    """Return the acceleration of a box down a ramp [m/s^2] of an angle `slope` [rad]."""
    turn = Pose((0.0, 0.0, 30.0), from_rpy(0.0, slope, 0.0))
    with empty_world() as world:
        world.spawn(rough(mu_ramp, '40 4 0.2', static=True), 'ramp', turn)
        box = world.spawn(rough(mu_box), 'box', compose(turn, Pose((0.0, 0.0, 0.1502))))
        world.run(200)
        before = math.hypot(*box.twist.linear)
        world.run(steps)
        return (math.hypot(*box.twist.linear) - before) / (steps / SECOND)


@pytest.mark.parametrize(
    ('mu_box', 'mu_ramp', 'mu'),
    [
        (0.5, 0.5, 0.5),
        (0.3, 0.3, 0.3),
        (0.3, 0.8, 0.3),
        (0.9, 0.4, 0.4),
        (1.0, 0.4, 0.4),
        (0.4, 1.0, 0.4),
        (100.0, 0.4, 0.4),
        (0.4, 100.0, 0.4),
        (0.0, 0.7, 0.0),
        (1.2, 1.2, 1.2),
        (1.2, 2.0, 1.2),
        (1.0, 1.0, 1.0),
        (1e6, 1.3, 1.3),
        (1.0, 1e6, 1.0),
    ],
)
def test_sliding_friction_is_that_of_the_lesser_mu(mu_box, mu_ramp, mu):
    holds, slides = math.atan(mu) - 0.02, math.atan(mu) + 0.1
    if mu:
        assert abs(acceleration_down(holds, mu_box, mu_ramp)) < 1e-3
    expected = GRAVITY * (math.sin(slides) - mu * math.cos(slides))
    assert acceleration_down(slides, mu_box, mu_ramp) == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize(
    ('cone', 'mu', 'speed'),
    [
        (False, 0.5, 1.5),
        (True, 0.5, 1.5),
        (False, 0.2, 1.0),
        (True, 0.2, 1.0),
    ],
)
def test_friction_on_the_diagonal_is_that_of_pyramid_or_cone(world, cone, mu, speed):
    along = math.sqrt(0.5) * speed
    world.set_physics(replace(world.physics, friction_cone=cone))
    box = world.spawn(rough(mu, '0.6 0.6 0.05'), 'box', Pose((0.0, 0.0, 0.025)))
    box.set_twist(Twist((along, along, 0.0), (0.0, 0.0, 0.0)))
    world.run(2 * SECOND)
    x, y, _ = box.pose.position
    braked = GRAVITY * mu * (math.sqrt(0.5) if cone else 1.0)  # along each axis [m/s^2]
    assert (x, y) == pytest.approx((along**2 / (2.0 * braked),) * 2, rel=0.03)


@pytest.mark.parametrize('mu', [2.0, 10.0, 100.0, 1e6])
def test_high_friction_resists_a_strong_push(world, mu):
    box = world.spawn(rough(mu, '0.6 0.6 0.05', 2.0), 'box', Pose((0.0, 0.0, 0.025)))
    world.run(200)
    start = box.pose.position
    push(world, [box], 1.4 * 2.0 * GRAVITY, SECOND)
    assert math.dist(box.pose.position, start) < 1e-3
    assert abs(acceleration_down(math.radians(55.0), mu, mu)) < 1e-3


@pytest.mark.parametrize(
    ('mu_low', 'mu_high', 'mu'),
    [
        (0.5, 0.5, 0.5),
        (0.3, 0.6, 0.3),
        (0.6, 0.3, 0.3),
        (1.0, 0.4, 0.4),
        (0.4, 1.0, 0.4),
        (100.0, 0.5, 0.5),
        (100.0, 1.0, 1.0),
    ],
)
def test_friction_between_movable_boxes_is_that_of_the_lesser_mu(world, mu_low, mu_high, mu):
    low = world.spawn(rough(mu_low, '8 2 0.1', 20.0), 'low', Pose((0.0, 0.0, 0.05)))
    high = world.spawn(rough(mu_high), 'high', Pose((0.0, 0.0, 0.15)))
    world.run(300)
    for force, steps in ((0.9 * mu * GRAVITY, 300), (1.5 * mu * GRAVITY, 500)):
        before = high.twist.linear[0] - low.twist.linear[0]
        push(world, [high], force, steps)
        gained = high.twist.linear[0] - low.twist.linear[0] - before
        slides = max(0.0, force - mu * GRAVITY) * steps / SECOND
        assert gained == pytest.approx(slides, rel=0.05, abs=2e-3)


def test_slippery_floor_applies_to_models_spawned_later(world):
    ground = world.models['ground_plane'].spec
    (link,) = ground.links
    (collision,) = link.collisions
    surface = replace(collision.surface, mu=0.2, mu2=0.2)
    link = replace(link, collisions=(replace(collision, surface=surface),))
    world.delete('ground_plane')
    boxes = [world.spawn(rough(0.3), 'early', Pose((0.0, 0.0, 0.05)))]
    world.spawn(replace(ground, links=(link,)), 'ground_plane', Pose())
    boxes += [world.spawn(rough(mu), f'box{mu}', Pose((0.0, 2.0 + mu, 0.05))) for mu in (1.0, 5.0)]
    boxes.append(world.spawn(urdf_spec(ball('ball', 0.05, 1.0)), 'ball', Pose((0, -2, 0.05))))
    push(world, boxes[:3], 3.0, SECOND)
    for box in boxes[:3]:
        assert box.twist.linear[0] == pytest.approx(3.0 - 0.2 * GRAVITY, rel=0.02)
    assert boxes[3].pose.position[2] == pytest.approx(0.05, abs=1e-3)


def test_a_slippery_floor_can_be_moved(world):
    bed = world.spawn(rough(0.4, '2 2 0.2', static=True), 'bed', Pose((9.0, 0.0, 1.0)))
    bed.set_pose(Pose((0.0, 0.0, 3.0)))
    for mu, x in ((0.2, -0.6), (1.0, 0.6)):
        box = world.spawn(rough(mu), f'box{mu}', Pose((x, 0.0, 3.2)))
        world.run(500)
        assert box.pose.position[2] == pytest.approx(3.15, abs=1e-3)


def test_robot_of_many_slippery_links_moves(world):
    link = """<link name="l{0}"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0"
      ixz="0" iyz="0"/></inertial><collision><geometry><sphere radius="0.1"/></geometry></collision>
      </link><gazebo reference="l{0}"><mu1>0.5</mu1></gazebo>"""
    joint = """<joint name="j{0}" type="continuous"><parent link="l0"/><child link="l{0}"/>
      <origin xyz="0 {0} 0"/></joint>"""
    text = ''.join(link.format(i) for i in range(80))
    text += ''.join(joint.format(i) for i in range(1, 80))
    model = world.spawn(urdf_spec(text), 'rake', Pose((0.0, 0.0, 0.1)))
    world.run(200)
    assert model.pose.position[2] == pytest.approx(0.1, abs=1e-3)


def test_surfaces_beyond_the_number_of_collision_groups_still_collide():
    pairs = FrictionPairs()
    coefficients = [0.01 * k for k in range(60)]
    for mu in coefficients:
        pairs.add(mu)
    floor = pairs.group_and_mask(Side(Kind.PLANE, Role.ONE, 10.0))
    for mu in coefficients:
        group, mask = pairs.group_and_mask(Side(Kind.MOVING, Role.OWN, mu))
        assert group & floor[1] and floor[0] & mask
        assert max(group, mask) < 1 << 31


def test_surface_of_mu_1_is_one_contact_part_and_others_are_two(world):
    for mu, parts in ((1.0, 1), (0.5, 2), (3.0, 2)):
        box = world.spawn(rough(mu), f'box{mu}', Pose((0.0, mu, 0.05)))
        assert len(box.body.surfaces['box']) == parts
    world.run(100)
    client = world.engine._client
    touching = [
        len(pybullet.getContactPoints(model.body.bodies[0], physicsClientId=client))
        for name, model in world.models.items()
        if name != 'ground_plane'
    ]
    assert touching == [4, 4, 4]


def test_a_factor_multiplies_the_mu_of_each_contact_part(world):
    box = world.spawn(rough(0.5), 'box', Pose((0.0, 0.0, 0.05)))
    world.engine.scale_friction(box.body, 'box', 0.4)
    parts = box.body.surfaces['box']
    found = [pybullet.getDynamicsInfo(*part, world.engine._client)[1] for part in parts]
    assert sorted(found) == pytest.approx([0.4 * 0.5, 0.4 * 1.0])  # of its own mu, and of 1
