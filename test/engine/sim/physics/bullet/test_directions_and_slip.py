"""Anisotropic friction, restitution and slip of tyres, within the accuracy of the engine."""

import math

import pytest
from support import ROOT, empty_world

from rosbots_description.sim.core.transforms import Pose, Twist, from_rpy, relative, rotate, yaw_of
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.resources.search_path import ModelSearch

SKID4 = ROOT / 'test' / 'data' / 'gazebo' / 'robots' / 'skid4.urdf'
GRAVITY = 9.8
LOAD = 4 * 29.4  # [N] on the four wheels of skid4
SPEED = 0.5  # [m/s]
# Off the world's axes and diagonals, the two directions of friction mix slightly.
SLIP_SHARE, MIXED_SHARE = 0.05, 0.25
BOX_SHARE = 0.001
COMPLIANCES = [(0.1, 0.0, 20.0), (0.4, 0.0, -8.0)]  # lateral, longitudinal, side force [N]


def box(surface, size='0.3 0.3 0.2', more=''):
    return load_sdf(
        f'<sdf version="1.6"><model name="m">{more}<link name="l"><inertial><mass>1</mass><inertia>'
        '<ixx>0.01</ixx><iyy>0.011</iyy><izz>0.015</izz></inertia></inertial><collision name="c">'
        f'<geometry><box><size>{size}</size></box></geometry><surface>{surface}</surface>'
        '</collision></link></model></sdf>',
        'box',
        find_model=ModelSearch(),
    )[0]


def slide(surface, direction, yaw=0.0, speed=1.5):
    """Return how far a box slides that starts in a direction of its own frame [rad]."""
    with empty_world() as world:
        model = world.spawn(box(surface), 'box', Pose((0.0, 0.0, 0.1), from_rpy(0.0, 0.0, yaw)))
        world.run(200)
        start, towards = model.pose.position, direction + yaw
        linear = (speed * math.cos(towards), speed * math.sin(towards), 0.0)
        model.set_twist(Twist(linear, (0.0, 0.0, 0.0)))
        world.run(1500)
        return math.dist(start, model.pose.position)


def friction(mu, mu2, more=''):
    return f'<friction><ode><mu>{mu}</mu><mu2>{mu2}</mu2>{more}</ode></friction>'


@pytest.mark.parametrize(('mu', 'mu2'), [(0.5, 0.2), (0.3, 0.6)])
@pytest.mark.parametrize('yaw', [0.0, math.pi / 2.0])
def test_mu2_acts_along_x_and_mu_along_y_of_the_model(mu, mu2, yaw):
    way = 1.5**2 / 2.0 / GRAVITY
    assert slide(friction(mu, mu2), 0.0, yaw) == pytest.approx(way / mu2, rel=0.04)
    assert slide(friction(mu, mu2), math.pi / 2.0, yaw) == pytest.approx(way / mu, rel=0.04)


def test_mu_acts_along_fdir1():
    surface = friction(0.5, 0.2, '<fdir1>1 0 0</fdir1>')
    way = 1.5**2 / 2.0 / GRAVITY
    assert slide(surface, 0.0) == pytest.approx(way / 0.5, rel=0.04)
    assert slide(surface, math.pi / 2.0) == pytest.approx(way / 0.2, rel=0.04)


@pytest.mark.parametrize('yaw', [0.0, math.pi / 2.0])
@pytest.mark.parametrize(('slip1', 'slip2', 'speed'), [(0.0, 0.05, 0.1), (0.2, 0.02, 0.04)])
def test_slip_velocity_is_slip_times_force(world, slip1, slip2, speed, yaw):
    surface = friction(1, 1, f'<slip1>{slip1}</slip1><slip2>{slip2}</slip2>')
    model = world.spawn(box(surface), 'box', Pose((0.0, 0.0, 0.1), from_rpy(0.0, 0.0, yaw)))
    for _ in range(1500):
        force = (2.0 * math.cos(yaw), 2.0 * math.sin(yaw), 0.0)
        model.links['l'].apply_wrench(force, (0.0, 0.0, 0.0))
        world.run(1)
    assert math.hypot(*model.twist.linear[:2]) == pytest.approx(speed, rel=BOX_SHARE)


@pytest.mark.parametrize('slab_comes', ['first', 'second'])
def test_slip_on_a_slab_does_not_depend_on_the_order_of_spawns(world, slab_comes):
    spawns = [
        (box('', '4 4 0.1', '<static>1</static>'), 'slab', Pose((0.0, 0.0, 0.05))),
        (
            box(friction(1, 1, '<slip1>0.2</slip1><slip2>0.02</slip2>')),
            'box',
            Pose((0.0, 0.0, 0.2)),
        ),
    ]
    for spawn in spawns if slab_comes == 'first' else reversed(spawns):
        world.spawn(*spawn)
    model = world.models['box']
    for _ in range(1500):
        model.links['l'].apply_wrench((2.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        world.run(1)
    assert model.twist.linear[0] == pytest.approx(0.04, rel=BOX_SHARE)


def bounce(restitution, max_vel):
    """Return the rebound height of a ball that falls 1 m onto a plate [m]."""
    surface = (
        f'<surface><bounce><restitution_coefficient>{restitution}</restitution_coefficient>'
        '<threshold>0.1</threshold></bounce>'
        f'<contact><ode><max_vel>{max_vel}</max_vel></ode></contact></surface>'
    )

    def model(name, shape, static):
        return load_sdf(
            f'<sdf version="1.6"><model name="{name}"><static>{static}</static><link name="l">'
            f'<collision name="c"><geometry>{shape}</geometry>{surface}</collision></link></model>'
            '</sdf>',
            name,
            find_model=ModelSearch(),
        )[0]

    with empty_world() as world:
        world.spawn(
            model('plate', '<box><size>1 1 0.1</size></box>', 1), 'plate', Pose((0.0, 0.0, 0.05))
        )
        ball = world.spawn(
            model('ball', '<sphere><radius>0.2</radius></sphere>', 0), 'ball', Pose((0.0, 0.0, 1.3))
        )
        world.run(470)
        highest = 0.0
        for _ in range(80):
            world.run(10)
            highest = max(highest, ball.pose.position[2])
        return highest - 0.3


@pytest.mark.parametrize('restitution', [0.5, 0.8])
def test_rebound_height_is_restitution_squared(restitution):
    assert bounce(restitution, 10000) == pytest.approx(restitution**2, abs=0.04)


def test_no_rebound_with_the_default_max_vel():
    assert bounce(0.8, 0.01) < 0.002


def drift(lateral, longitudinal, force, yaw):
    """Return the forward and lateral speed of skid4 [m/s] while a force acts on it.

    Args:
        force: on its body, in its own axes [N].
    """
    wheels = ''.join(
        f'<wheel link_name="{side}_{end}_link">'
        f'<slip_compliance_lateral>{lateral}</slip_compliance_lateral>'
        f'<slip_compliance_longitudinal>{longitudinal}</slip_compliance_longitudinal>'
        f'<wheel_normal_force>{LOAD / 4}</wheel_normal_force></wheel>'
        for side in ('left', 'right')
        for end in ('front', 'rear')
    )
    plugin = (
        '<gazebo><plugin name="slip" filename="libgazebo_ros_wheel_slip.so">'
        f'{wheels}</plugin></gazebo></robot>'
    )
    text = SKID4.read_text(encoding='utf-8').replace('</robot>', plugin)
    with empty_world() as world:
        model = world.spawn(
            load_urdf(text, 'skid4')[0], 'robot', Pose((0.0, 0.0, 0.02), from_rpy(0.0, 0.0, yaw))
        )
        world.run(500)
        next(iter(model.plugins.values())).command(SPEED, 0.0)
        body, start = model.links['base_footprint'], None
        for step in range(1000):
            body.apply_wrench(rotate(model.pose.orientation, force), (0.0, 0.0, 0.0))
            world.run(1)
            start = model.pose if step == 499 else start
        x, y, _ = relative(model.pose, start).position
        assert abs(yaw_of(model.pose.orientation) - yaw) < 0.01
        return x / 0.5, y / 0.5


@pytest.mark.parametrize(('lateral', 'longitudinal', 'force'), COMPLIANCES)
@pytest.mark.parametrize('yaw', [0.0, math.pi / 4.0])
def test_lateral_slip_follows_the_lateral_compliance(lateral, longitudinal, force, yaw):
    x, y = drift(lateral, longitudinal, (0.0, force, 0.0), yaw)
    assert y == pytest.approx(SPEED * lateral * force / LOAD, rel=SLIP_SHARE)
    assert x == pytest.approx(SPEED, rel=0.01)


def test_longitudinal_slip_follows_the_longitudinal_compliance():
    x, _ = drift(0.0, 0.5, (-20.0, 0.0, 0.0), 0.0)
    assert SPEED - x == pytest.approx(SPEED * 0.5 * 20.0 / LOAD, rel=SLIP_SHARE)


def test_slip_between_the_axes_of_the_world_is_less_exact():
    _, y = drift(0.1, 0.0, (0.0, 20.0, 0.0), 0.3)
    assert y == pytest.approx(SPEED * 0.1 * 20.0 / LOAD, rel=MIXED_SHARE)


def test_no_slip_without_compliance():
    x, y = drift(0.0, 0.0, (-20.0, 20.0, 0.0), 0.3)
    assert abs(y) < 1e-3
    assert x == pytest.approx(SPEED, rel=0.01)
