"""Springs and dampers of joints obey mechanics at any stiffness and damping."""

import math
from contextlib import closing

import pytest
from support import urdf_spec
from support.fast_body import masses
from support.scenes import GRAVITY, box

from rosbots_description.sim.core.transforms import Pose, Twist
from rosbots_description.sim.description.model_spec import (
    PRISMATIC,
    REVOLUTE,
    Inertial,
    JointSpec,
    LinkSpec,
    ModelSpec,
)
from rosbots_description.sim.description.physics_settings import PhysicsSettings
from rosbots_description.sim.physics.bullet.springs import followed_damping, followed_stiffness
from rosbots_description.sim.runtime.world import World

HIGH = Pose((0.0, 0.0, 100.0))
SPRUNG = '<gazebo reference="{}"><springStiffness>{}</springStiffness></gazebo>'


def weight(mass, inertia=1.0, **joint):
    """Return a mass on a vertical joint of the world."""
    link = LinkSpec('weight', inertial=Inertial(mass, Pose(), inertia, inertia, inertia))
    return ModelSpec(
        'weight',
        (link,),
        (JointSpec('joint', joint.pop('type', PRISMATIC), 'world', 'weight', **joint),),
    )


def states(spec, steps, velocity=0.0, **physics):
    """Return the state of the joint after each step."""
    with closing(World(PhysicsSettings(**physics))) as world:
        model = world.spawn(spec, 'weight', HIGH)
        (joint,) = model.joints.values()
        if velocity:
            joint.apply_effort(velocity * spec.links[0].inertial.ixx / world.physics.step_size)
        found = []
        for _ in range(steps):
            world.run(1)
            found.append(joint.state())
        return found


@pytest.mark.parametrize(
    ('mass', 'stiffness', 'reference', 'step'),
    [
        (2.0, 50.0, 0.0, 0.001),
        (0.5, 2000.0, 0.3, 0.001),
        (30.0, 200.0, -0.2, 0.004),
    ],
)
def test_mass_on_a_spring_oscillates_without_loss(mass, stiffness, reference, step):
    sag, rate = mass * GRAVITY / stiffness, math.sqrt(stiffness / mass)
    spec = weight(mass, stiffness=stiffness, reference=reference)
    # It starts at zero; both extremes are equally far from the equilibrium.
    way = abs(reference - sag)
    steps = round(20.0 * math.tau / rate / step)
    positions = [position for position, _ in states(spec, steps, step_size=step)]
    for part in (positions[: steps // 20 + 1], positions[-steps // 20 - 1 :]):
        assert max(part) == pytest.approx(reference - sag + way, abs=0.004 * way)
        assert min(part) == pytest.approx(reference - sag - way, abs=0.004 * way)
    # After twenty periods it is at zero again.
    assert positions[-1] == pytest.approx(0.0, abs=0.04 * way)


@pytest.mark.parametrize('stiffness', [10.0, 1e4, 1e6, 1e9, 1e300])
@pytest.mark.parametrize('step', [0.001, 0.01])
def test_spring_of_any_stiffness_gains_no_energy(stiffness, step):
    spec = weight(1.0, 0.01, type=REVOLUTE, stiffness=stiffness)
    found = states(spec, 3000, velocity=0.5, step_size=step, gravity=(0.0, 0.0, 0.0))
    assert max(abs(velocity) for _, velocity in found) <= 0.5 * 1.16  # 1 / cos of 30 degrees
    assert max(abs(velocity) for _, velocity in found[-200:]) >= 0.49  # and loses none


@pytest.mark.parametrize('damping', [0.1, 5.0, 15.0, 40.0, 1e4, 1e300])
def test_damper_of_any_strength_does_not_reverse_motion(damping):
    spec = weight(1.0, 0.01, type=REVOLUTE, damping=damping)
    velocities = [velocity for _, velocity in states(spec, 100, velocity=1.0)]
    assert velocities == sorted(velocities, reverse=True)
    assert velocities[-1] >= 0.0
    assert velocities[50] == pytest.approx(max(0.0, 1.0 - damping * 0.1) ** 50, abs=1e-9)


@pytest.mark.parametrize(
    ('stiffness', 'damping'),
    [
        (1e9, 0.0),
        (1e9, 1e9),
        (20.0, 1e9),
        (1e3, 0.0),
        (0.0, 1e9),
    ],
)
@pytest.mark.parametrize('count', [2, 6, 12])
def test_floating_chain_with_springs_is_stable(stiffness, damping, count):
    rod = Inertial(0.2, Pose((0.05, 0.0, 0.0)), 1e-4, 1e-4, 1e-4)
    links = tuple(LinkSpec(f'link{i}', Pose((0.1 * i, 0.0, 0.0)), rod) for i in range(count))
    joints = tuple(
        JointSpec(
            f'joint{i}',
            REVOLUTE,
            f'link{i - 1}',
            f'link{i}',
            axis=(0.0, i % 2, 1.0 - i % 2),
            stiffness=stiffness,
            damping=damping,
        )
        for i in range(1, count)
    )
    with closing(World(PhysicsSettings(gravity=(0.0, 0.0, 0.0)))) as world:
        model = world.spawn(ModelSpec('chain', links, joints), 'chain', HIGH)
        model.set_twist(Twist((0.0, 0.0, 0.0), (0.0, 0.3, 0.2)))
        for _ in range(50):
            world.run(100)
            assert all(abs(joint.velocity) < 2.0 for joint in model.joints.values())


def carriage(mass, stiffness, damping):
    """Return a body on four sprung feet; stiffness and damping are per foot."""
    text = box('base', (0.5, 0.4, 0.1), mass)
    for i, (x, y) in enumerate(((0.2, 0.2), (0.2, -0.2), (-0.2, 0.2), (-0.2, -0.2))):
        text += (
            f'<link name="foot{i}"><inertial><mass value="{0.03 * mass}"/><inertia ixx="1e-3" '
            'iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry>'
            f'<sphere radius="0.05"/></geometry></collision></link><joint name="joint{i}" '
            f'type="prismatic"><parent link="base"/><child link="foot{i}"/><origin xyz="{x} {y} '
            '-0.1"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1e9" velocity="99"/>'
            f'<dynamics damping="{damping}"/></joint>'
        ) + SPRUNG.format(f'joint{i}', stiffness)
    return urdf_spec(text)


@pytest.mark.parametrize(
    ('mass', 'stiffness', 'damping'),
    [
        (8.0, 2000.0, 50.0),
        (8.0, 2000.0, 1e6),
        (40.0, 1e4, 500.0),
        (1.0, 300.0, 10.0),
    ],
)
def test_deflection_of_a_sprung_body_is_weight_over_stiffness(world, mass, stiffness, damping):
    model = world.spawn(carriage(mass, stiffness, damping), 'carriage', Pose((0.0, 0.0, 0.17)))
    world.run(4000)
    sag = mass * GRAVITY / 4.0 / stiffness
    assert model.joint('joint0').position == pytest.approx(sag, rel=0.01)
    assert model.pose.position[2] == pytest.approx(0.15 - sag, abs=1e-3)


def test_springs_too_stiff_for_the_step_size_are_at_rest_under_a_body(world):
    model = world.spawn(carriage(8.0, 1e12, 0.0), 'carriage', Pose((0.0, 0.0, 0.17)))
    world.run(3000)
    assert model.pose.position[2] == pytest.approx(0.15, abs=2e-3)
    for _ in range(200):
        world.run(1)
        assert max(abs(joint.velocity) for joint in model.joints.values()) < 1e-3


def test_spring_acts_beside_efforts_and_motors_and_after_changes(world):
    model = world.spawn(weight(1.0, stiffness=100.0, damping=5.0), 'weight', HIGH)
    joint = model.joint('joint')
    for _ in range(4000):
        joint.apply_effort(20.0)
        world.run(1)
    assert joint.position == pytest.approx((20.0 - GRAVITY) / 100.0, rel=1e-3)
    model.respecify(model.spec)
    world.run(4000)
    rest = -GRAVITY / 100.0
    assert model.joint('joint').position == pytest.approx(rest, rel=1e-3)
    model.joint('joint').set_motor(0.1, 3.0)  # drives against the spring until both balance
    world.run(4000)
    assert model.joint('joint').position == pytest.approx(rest + 0.03, rel=0.01)


def test_motion_after_a_reset_is_bit_identical(world):
    model = world.spawn(weight(1.0, stiffness=100.0), 'weight', HIGH)
    ways = []
    for _ in range(2):
        world.run(777)
        ways.append(model.joint('joint').state())
        world.reset_simulation()
    assert ways[0] == ways[1]
    world.delete('weight')
    world.run(10)


@pytest.mark.parametrize('limited', [followed_stiffness, followed_damping])
def test_a_body_of_four_times_the_mass_follows_four_times_the_stiffness_and_damping(limited):
    body = masses(stiffness=1e15, damping=1e15)  # far too much for the step size
    (once,), (scaled,) = limited(body, 0.002), limited(body.scaled(4.0), 0.002)
    assert scaled == pytest.approx(4.0 * once)
