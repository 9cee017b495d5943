"""Free rotation conserves energy at any speed; no system gains energy."""

import math
from contextlib import closing
from dataclasses import replace

import numpy as np
import pytest
from support import box_urdf, robot_spec, urdf_spec

from rosbots_description.sim.core.transforms import (
    UP,
    Pose,
    Twist,
    add,
    compose,
    conjugate,
    cross,
    rotate,
)
from rosbots_description.sim.description.inertia import principal_axes
from rosbots_description.sim.description.model_spec import (
    REVOLUTE,
    Box,
    Collision,
    Inertial,
    JointSpec,
    LinkSpec,
    ModelSpec,
    Surface,
)
from rosbots_description.sim.description.physics_settings import PhysicsSettings
from rosbots_description.sim.runtime.world import World

SECOND = 1000  # steps
GRAVITY = 9.8
HIGH = Pose((0.0, 0.0, 2000.0))


def energies(model):
    """Return the total energy of a model, and the kinetic energy about its centre of mass [J]."""
    height, kinetic, momentum, mass = 0.0, 0.0, np.zeros(3), 0.0
    for link in model.links.values():
        inertial = link.spec.inertial
        pose, twist = link.state()
        arm = rotate(pose.orientation, inertial.pose.position)
        velocity = np.array(add(twist.linear, cross(twist.angular, arm)))
        moments, axes = principal_axes(inertial)
        axes = compose(pose, Pose(orientation=axes)).orientation
        own = rotate(conjugate(axes), twist.angular)
        kinetic += 0.5 * inertial.mass * velocity @ velocity
        kinetic += 0.5 * sum(i * w * w for i, w in zip(moments, own, strict=True))
        height += GRAVITY * inertial.mass * (pose.position[2] + arm[2])
        momentum += inertial.mass * velocity
        mass += inertial.mass
    return height + kinetic, kinetic - 0.5 * momentum @ momentum / mass


def body(moments, com=(0.0, 0.0, 0.0), mu=1.0):
    shape = Collision('box', Box((0.1, 0.1, 0.1)), surface=Surface(mu=mu))
    return ModelSpec(
        'body',
        (LinkSpec('link', inertial=Inertial(1.0, Pose(com), *moments), collisions=(shape,)),),
    )


def chain(count, length, mass=1.0, hangs=True):
    """Return a chain of rods along x; if `hangs`, its first end is on a joint to the world."""
    moment = mass * length**2 / 12.0
    rod = Inertial(mass, Pose((length / 2.0, 0.0, 0.0)), mass * 1e-4, moment, moment)
    links = tuple(LinkSpec(f'link{i}', Pose((i * length, 0.0, 0.0)), rod) for i in range(count))
    joints = tuple(
        JointSpec(f'joint{i}', REVOLUTE, parent, f'link{i}', axis=(0.0, 1.0, 0.0))
        for i, parent in enumerate(['world', *(link.name for link in links[:-1])])
        if i or hangs
    )
    return ModelSpec('chain', links, joints)


def share_kept(spec, velocity, seconds, **settings):
    """Return the least and the greatest share of its initial energy of a flying model."""
    with closing(World(PhysicsSettings(**settings))) as world:
        model = world.spawn(spec, 'model', HIGH)
        model.set_twist(Twist((1.0, 2.0, 3.0), velocity))
        shares = [energies(model)[1]]
        steps = round(0.05 / world.physics.step_size)
        for _ in range(round(seconds / 0.05)):
            world.run(steps)
            shares.append(energies(model)[1])
    return min(shares) / shares[0], max(shares) / shares[0]


@pytest.mark.parametrize(
    ('moments', 'com', 'speed', 'mu'),
    [
        ((0.1, 0.2, 0.3), (0.0, 0.0, 0.0), 10.0, 1.0),  # about the middle axis
        ((0.1, 0.2, 0.3), (0.0, 0.0, 0.0), 60.0, 1.0),
        ((0.1, 0.2, 0.3), (0.0, 0.0, 0.0), 60.0, 0.5),
        ((0.01, 0.105, 0.11), (0.4, 0.0, 0.1), 37.0, 1.0),  # a stick, thrown by its end
        ((0.01, 0.105, 0.11), (0.4, 0.0, 0.1), 10.0, 2.0),
        ((0.3, 0.2, 0.2), (0.0, 0.0, 0.0), 60.0, 1.0),
    ],
)
def test_spinning_body_keeps_its_energy(moments, com, speed, mu):
    least, most = share_kept(body(moments, com, mu), (0.01 * speed, speed, 0.03 * speed), 4.0)
    assert least > 0.988
    assert most < 1.014


@pytest.mark.parametrize('speed', [300.0, 3e3, 1e5])
@pytest.mark.parametrize('mu', [1.0, 0.5])
def test_extreme_spin_gains_no_energy(speed, mu):
    _, most = share_kept(body((0.1, 0.2, 0.3), mu=mu), (3.0, speed, 0.0), 2.0)
    assert most < 1.02


def test_energy_is_kept_with_longer_steps():
    least, most = share_kept(body((0.1, 0.2, 0.3)), (1.0, 40.0, 0.0), 10.0, step_size=0.004)
    assert (least, most) == pytest.approx((1.0, 1.0), abs=0.02)


@pytest.mark.parametrize('velocity', [(60.0, 0.0, 1.0), (7.0, -15.0, 10.0)])
def test_tumbling_robot_keeps_its_energy(velocity):
    least, most = share_kept(robot_spec(), velocity, 4.0)
    assert least > 0.96
    assert most < 1.014


def swing(spec, seconds):
    """Return the changes of the total energy [J], and the greatest speed of a link [m/s]."""
    with closing(World()) as world:
        model = world.spawn(spec, 'model', Pose())
        start = energies(model)[0]
        changes, fastest = [], 0.0
        for _ in range(round(seconds * 50)):
            world.run(20)
            changes.append(energies(model)[0] - start)
            fastest = max(
                fastest, *(math.hypot(*link.twist.linear) for link in model.links.values())
            )
    return changes, fastest


@pytest.mark.parametrize(('count', 'length'), [(2, 0.2), (2, 1.0), (4, 0.5)])
def test_pendulum_of_several_rods_gains_no_energy_and_keeps_swinging(count, length):
    changes, _ = swing(chain(count, length), 3.0)
    there = GRAVITY * length * count**2 / 2.0  # greatest loss of potential energy [J]
    assert max(changes) < 0.02 * there
    assert min(changes) > -0.17 * there


@pytest.mark.parametrize(
    ('count', 'length', 'mass'), [(30, 0.1, 1.0), (40, 0.2, 0.1), (50, 0.1, 5.0)]
)
def test_released_long_chain_gains_no_energy(count, length, mass):
    changes, fastest = swing(chain(count, length, mass), 2.0)
    assert max(changes) < 0.02 * GRAVITY * mass * length * count**2 / 2.0
    assert fastest < 15.0 * math.sqrt(GRAVITY * count * length)


def test_single_pendulum_keeps_its_amplitude():
    changes, _ = swing(chain(1, 1.0), 4.0)
    assert max(map(abs, changes)) < 0.005 * GRAVITY


def test_thrown_chain_gains_no_speed(world):
    spec = chain(30, 0.1, hangs=False)
    shape = Collision('ball', Box((0.08, 0.04, 0.04)), Pose((0.05, 0.0, 0.0)))
    links = tuple(replace(link, collisions=(shape,)) for link in spec.links)
    model = world.spawn(ModelSpec('chain', links, spec.joints), 'chain', Pose((0, 0, 2.0)))
    model.set_twist(Twist((0.0, 0.0, 3.0), (1.0, 8.0, 0.0)))
    start = energies(model)[0]
    for _ in range(20):
        world.run(100)
        assert energies(model)[0] < 1.02 * start


def test_motor_may_add_energy_to_its_load(world):
    arm = chain(2, 0.5)
    model = world.spawn(arm, 'arm', Pose((0.0, 0.0, 5.0)))
    model.joint('joint0').set_motor(20.0, 200.0)
    world.run(2 * SECOND)
    assert model.joint('joint0').velocity == pytest.approx(20.0, rel=0.05)


@pytest.mark.parametrize(
    ('size', 'speed', 'height', 'inertia'),
    [
        ((0.5, 0.5, 0.05), 10.0, 0.3, 1.0),
        ((0.3, 0.3, 0.2), 50.0, 0.1, 1.0),
        ((0.2, 0.2, 0.02), 25.0, 2.0, 1.0),
        ((1.0, 0.4, 0.04), 5.0, 1.0, 1.0),
        ((0.4, 0.4, 0.1), 20.0, 1.5, 5.0),
    ],
)
def test_box_spinning_about_the_vertical_lands_flat(world, size, speed, height, inertia):
    x, y, z = (inertia * length**2 / 12.0 for length in size)
    text = box_urdf(' '.join(map(str, size)), 1.0).replace(
        'ixx="0.1" iyy="0.1" izz="0.1"', f'ixx="{y + z}" iyy="{x + z}" izz="{x + y}"'
    )
    box = world.spawn(urdf_spec(text), 'box', Pose((0.0, 0.0, height)))
    box.set_twist(Twist((0.0, 0.0, 0.0), (0.0, 0.0, speed)))
    for _ in range(2 * SECOND):
        world.run(1)
        assert rotate(box.pose.orientation, UP)[2] > math.cos(0.02)
    assert box.pose.position[2] == pytest.approx(size[2] / 2.0, abs=1e-3)
