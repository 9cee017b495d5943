"""Mechanics of wheels in contact: robots that drive, park, overturn and ride on moving bodies."""

import itertools
import math
from dataclasses import replace
from typing import NamedTuple

import pytest
from support import SETTLED, SPAWN_POSE, empty_world, robot_spec, urdf_spec
from support.scenes import (
    DRIVE_PLUGIN,
    GRAVITY,
    ball,
    box,
    castered,
    forward_speed,
    spec_height,
    surface,
    tilted_floor,
    wheel,
    with_tags,
)

from rosbots_description.sim.core.transforms import (
    UP,
    Pose,
    Twist,
    add,
    compose,
    conjugate,
    cross,
    dot,
    from_rpy,
    inverse,
    rotate,
    subtract,
    yaw_of,
)
from rosbots_description.sim.description.model_spec import Cylinder, Element
from rosbots_description.sim.physics.bullet.body import Place
from rosbots_description.sim.physics.bullet.client import pybullet
from rosbots_description.sim.physics.bullet.tuning import Tuning
from rosbots_description.sim.runtime.outputs import FrameTransform, JointStates, Odometry

CONVERGED = Tuning(iterations=3.0)  # 150
SPEED_REACHED = 750  # steps after which a slow robot moves at a steady speed, the ramp included
LIGHT = castered(1.0, 0.2, casters=1)
MIDDLE = castered(casters=1)
HEAVY = castered(50.0, 1.0, casters=2, mu=0.1)


def command(model, forward, turning):
    for plugin in model.plugins.values():
        plugin.command(forward, turning)


def placed(world, spec, frame=None, yaw=0.0):
    """Return the robot after half a second at rest in a frame."""
    pose = Pose((0.0, 0.0, spec_height(spec)), from_rpy(0.0, 0.0, yaw))
    model = world.spawn(spec, 'robot', compose(frame or Pose(), pose))
    world.run(500)
    return model


def within(frame, model):
    return compose(inverse(frame), model.pose)


def turned(model, world, steps):
    """Return the angle by which a model turns within `steps` [rad]."""
    total, before = 0.0, yaw_of(model.pose.orientation)
    for _ in range(steps // 50):
        world.run(50)
        now = yaw_of(model.pose.orientation)
        total += math.remainder(now - before, math.tau)
        before = now
    return total


@pytest.mark.parametrize(
    ('spec', 'degrees', 'speed'),
    [
        (MIDDLE, 20.0, 0.5),
        (LIGHT, -20.0, 0.2),
        (HEAVY, 15.0, 0.8),
        (MIDDLE, 20.0, 0.0),
    ],
)
def test_robot_driving_across_a_slope_does_not_slide_down(world, spec, degrees, speed):
    frame = tilted_floor(world, roll=math.radians(degrees))
    model = placed(world, spec, frame)
    before = within(frame, model).position
    command(model, speed, 0.0)
    world.run(2000)
    after = within(frame, model).position
    assert abs(after[1] - before[1]) < 0.01 * 2.0
    assert after[0] - before[0] > 0.7 * 2.0 * speed - 0.01


@pytest.mark.parametrize(
    ('spec', 'degrees', 'speed', 'heading'),
    [
        (castered(0.5, 0.15, casters=1), 15.0, 1.0, 0.3),
        (LIGHT, 20.0, 0.5, 0.8),
        (LIGHT, 10.0, 0.2, math.pi),
        (castered(1.0, 0.2), 15.0, 1.0, 0.3),
        (MIDDLE, -20.0, 1.0, 0.8),
        (castered(20.0, 0.6, casters=1), 20.0, 1.0, 0.3),
        (castered(20.0, 0.6, mu=0.1), 25.0, 0.5, 0.8),
        # At 1 m/s^2 the upper wheel, with a quarter of the weight, would spin.
        (castered(5.0, 0.4, casters=1, acceleration=0.2), 25.0, 0.5, 0.8),
    ],
)
def test_tyres_on_a_slope_do_not_slip_sideways(world, spec, degrees, speed, heading):
    """Lateral slip along the axle; motor velocity error turns the robot slightly, without slip."""
    model = placed(world, spec, tilted_floor(world, roll=math.radians(degrees)), heading)
    command(model, speed, 0.0)
    before = model.pose.orientation
    slip = ahead = 0.0
    for _ in range(3000):
        world.run(1)
        pose, twist = model.state()
        along = rotate(conjugate(pose.orientation), twist.linear)
        ahead, slip = ahead + 0.001 * along[0], slip + 0.001 * along[1]
    assert abs(slip) < 0.002 * 3.0
    assert ahead > 0.5 * 3.0 * speed
    turn = compose(inverse(Pose(orientation=before)), Pose(orientation=pose.orientation))
    assert abs(yaw_of(turn.orientation)) < 0.08


@pytest.mark.parametrize(
    ('spec', 'degrees', 'speed'),
    [
        (LIGHT, 15.0, 0.02),
        (LIGHT, 20.0, 0.22),
        (LIGHT, 12.0, 0.03),
        (MIDDLE, 10.0, 0.05),
    ],
)
def test_slow_robot_climbs_a_ramp_as_commanded_without_rolling_back(world, spec, degrees, speed):
    frame = tilted_floor(world, pitch=-math.radians(degrees))
    model = placed(world, spec, frame)
    command(model, speed, 0.0)
    world.run(1000)
    ways = []
    for _ in range(20):
        ways.append(within(frame, model).position[0])
        world.run(100)
    assert min(b - a for a, b in itertools.pairwise(ways)) > 0.0
    assert (ways[-1] - ways[0]) / 1.9 == pytest.approx(speed, rel=0.05)


@pytest.mark.parametrize('spec', [LIGHT, MIDDLE, HEAVY], ids=['1 kg', '5 kg', '50 kg'])
def test_slow_commands_are_followed_on_level_ground(world, spec):
    model = placed(world, spec)
    command(model, 0.01, 0.0)
    world.run(SPEED_REACHED)
    before = model.pose.position
    world.run(1500)
    assert math.dist(model.pose.position, before) / 1.5 == pytest.approx(0.01, rel=0.05)


@pytest.mark.parametrize(
    ('spec', 'rate'),
    [
        (MIDDLE, 0.1),
        (MIDDLE, -0.1),
        (LIGHT, 0.1),
        (HEAVY, -0.1),
        (castered(0.2, 0.12, casters=1), 0.1),
        (castered(20.0, 0.6, casters=1), -0.1),
    ],
)
def test_slow_turns_are_followed(world, spec, rate):
    """Within what a wheel makes of it that turns about one of its outer crests: b / 2R, 6 %."""
    model = placed(world, spec)
    command(model, 0.0, rate)
    world.run(SPEED_REACHED)
    assert turned(model, world, 1500) / 1.5 == pytest.approx(rate, rel=0.065)


def share_turned(size, mu):
    """Return the yaw rate of a robot on two casters relative to the command, by Coulomb's law.

    Eight points carry equal loads: two casters, and three crests of each wheel. At the
    full rate a wheel turns about its middle: the inner crest drives, the outer one brakes, the
    middle one is below its limit. If its caster needs more than that, the middle slips too, and
    the wheel turns about its outer crest.
    """
    track = caster = 0.4 * size  # from the middle of the robot to that of a wheel, to a caster [m]
    half = 0.05 * size - 0.001  # from the middle of a wheel to that of an outer crest [m]
    most = (track - half) + track - (track + half)  # torque of a wheel, in loads of one point
    return 1.0 if mu * caster <= most else track / (track + half)


@pytest.mark.parametrize(
    ('mass', 'size', 'mu', 'rate', 'yaw'),
    [
        (0.2, 0.12, 1.0, 0.1, 0.4),
        (1.0, 0.2, 1.0, -0.1, 0.0),
        (1.0, 0.2, 0.9, 0.3, 0.4),
        (5.0, 0.4, 1.0, 0.3, 0.0),
        (20.0, 0.6, 1.0, -0.1, 0.4),
        (50.0, 1.0, 1.0, 0.1, 0.0),
        (0.2, 0.12, 0.6, 0.1, 0.4),
        (1.0, 0.2, 0.7, 0.3, 0.0),
        (5.0, 0.4, 0.6, -0.1, 0.4),
    ],
)
def test_yaw_rate_with_broad_wheels_and_casters_is_that_of_coulomb(mass, size, mu, rate, yaw):
    """Solved to convergence; otherwise the wheels turn about any crest from the middle outwards."""
    for tuning in (CONVERGED, None):
        with empty_world(tuning) as world:
            model = placed(world, castered(mass, size, casters=2, mu=mu), yaw=yaw)
            command(model, 0.0, rate)
            world.run(SPEED_REACHED)
            share = turned(model, world, 1500) / 1.5 / rate
        if tuning:
            assert share == pytest.approx(share_turned(size, mu), rel=0.02)
        else:
            assert 0.98 * share_turned(size, 1.0) < share < 1.02


@pytest.mark.parametrize(
    ('spec', 'degrees', 'yaw'),
    [
        (MIDDLE, 10.0, 0.0),
        (LIGHT, 10.0, 0.7),
        (LIGHT, 3.0, 0.0),
        (castered(20.0, 0.6), 15.0, 0.4),
    ],
)
def test_a_parked_robot_does_not_creep(world, spec, degrees, yaw):
    model = placed(world, spec, tilted_floor(world, pitch=-math.radians(degrees)), yaw)
    world.run(1000)
    before = model.pose.position
    world.run(5000)
    assert math.dist(before, model.pose.position) < 1e-4


def tall(mass=4.0, size=0.4):
    """Return a robot with a tall body: when overturned, its wheels turn in the air."""
    body = box('base', (size, 0.7 * size, size), 0.9 * mass)
    for side, y in (('left', 0.4 * size), ('right', -0.4 * size)):
        body += wheel(
            f'{side}_wheel',
            f'{side}_joint',
            0.15 * size,
            0.1 * size,
            0.05 * mass,
            f'0 {y} {-0.4 * size}',
        )
    return urdf_spec(
        body
        + DRIVE_PLUGIN.format(
            separation=0.8 * size, diameter=0.3 * size, torque=mass, acceleration=0.0
        )
    )


@pytest.mark.parametrize(
    ('mass', 'size', 'forward', 'turning'),
    [
        (4.0, 0.4, 0.5, 0.0),
        (1.0, 0.2, 0.2, 1.0),
        (40.0, 0.8, -1.0, 0.0),
    ],
)
@pytest.mark.parametrize('degrees', [0.0, 5.0])
def test_overturned_robot_with_turning_wheels_stays_in_place(
    world, mass, size, forward, turning, degrees
):
    frame = tilted_floor(world, roll=math.radians(degrees))
    pose = Pose((0.0, 0.0, size / 2.0 + 0.001), from_rpy(math.pi, 0.0, 0.0))
    model = world.spawn(tall(mass, size), 'robot', compose(frame, pose))
    command(model, forward, turning)
    world.run(500)
    before = model.pose.position
    for _ in range(2000):
        if not degrees:
            push = (0.0, 0.3 * mass * GRAVITY, 0.0)
            x, y, z = model.pose.position
            world.engine.apply_wrench(
                model.body, 'base', push, (0.0, 0.0, 0.0), (x, y, z - 0.4 * size)
            )
        world.run(1)
    assert math.dist(model.pose.position, before) < 0.01


BED = (
    '<joint name="j" type="prismatic"><parent link="world"/><child link="bed"/>'
    '<axis xyz="1 0 0"/><limit lower="-99" upper="99" effort="1e6" velocity="99"/></joint>'
)
TURNTABLE = (
    '<joint name="j" type="continuous"><parent link="world"/><child link="bed"/>'
    '<axis xyz="0 0 1"/></joint>'
)


@pytest.mark.parametrize(
    ('spec', 'joint', 'moves', 'speed'),
    [
        (MIDDLE, BED, 0.2, 0.05),
        (LIGHT, BED, -0.5, 0.02),
        (MIDDLE, TURNTABLE, 0.2, 0.02),
        (LIGHT, TURNTABLE, -0.3, 0.05),
    ],
)
def test_robot_on_a_moving_platform_moves_with_it(world, spec, joint, moves, speed):
    bed = world.spawn(
        urdf_spec('<link name="world"/>' + box('bed', (6.0, 6.0, 0.1), 500.0) + joint),
        'bed',
        Pose((0.0, 0.0, 0.5)),
    )
    carrier = bed.links['bed']
    model = placed(world, spec, Pose((0.5, 0.0, 0.55)), yaw=0.7)
    command(model, speed, 0.0)
    world.run(500)
    before = within(carrier.pose, model)
    for i in range(100):
        bed.joint('j').set_motor(moves * (i + 1) / 100.0, 1e6)
        world.run(10)
    world.run(2000)
    expected = compose(before, Pose((3.0 * speed, 0.0, 0.0)))
    after = within(carrier.pose, model)
    assert math.dist(after.position[:2], expected.position[:2]) < 0.006


class Touch(NamedTuple):
    """A contact of a robot in the latest step."""

    limit: float  # mu times the load [N]
    held: float  # greatest friction component [N]
    power: float  # of the friction [W]


def touches(world, model):
    """Yield all contacts of a robot with a static floor."""
    client = world.engine._client
    owners = {place: link for link, places in model.body.surfaces.items() for place in places}
    # Queried for one body, PyBullet would swap the sides of a point, but not friction.
    for point in pybullet.getContactPoints(physicsClientId=client):
        sides = [Place(point[1], point[3]), Place(point[2], point[4])]
        own, at, sign = (
            (sides[0], point[5], 1.0) if sides[0] in owners else (sides[1], point[6], -1.0)
        )
        pose, (linear, angular) = world.engine.link_state(model.body, owners[own])
        origin = subtract(pose.position, tuple(0.001 * v for v in linear))  # when it touched
        mu = math.prod(pybullet.getDynamicsInfo(*side, client)[1] for side in sides)
        slip = add(linear, cross(angular, subtract(at, origin)))
        one, two = sign * point[10], sign * point[12]
        yield Touch(
            mu * point[9],
            max(abs(one), abs(two)),
            one * dot(point[11], slip) + two * dot(point[13], slip),
        )


@pytest.mark.parametrize(('spec', 'heading'), [(MIDDLE, 0.0), (LIGHT, 0.4), (HEAVY, 1.1)])
def test_friction_never_accelerates_a_sliding_robot(world, spec, heading):
    model = placed(world, spec, yaw=heading)
    cos, sin = math.cos(heading), math.sin(heading)
    model.set_twist(Twist((0.3 * cos - 0.4 * sin, 0.3 * sin + 0.4 * cos, 0.0)))
    fastest = math.hypot(*model.twist.linear[:2])
    for _ in range(200):
        world.run(1)
        assert math.hypot(*model.twist.linear[:2]) <= fastest


# Robots on one caster tip onto their front edge and back when they start backwards.
@pytest.mark.parametrize(
    ('spec', 'heading', 'degrees', 'commands'),
    [
        (LIGHT, 0.4, 0.0, ((0.5, 0.0), (-0.5, 0.0))),
        (LIGHT, 0.4, 12.0, ((1.0, 1.0), (-1.0, 0.0))),
        (MIDDLE, 1.1, 0.0, ((1.0, 1.0), (-1.0, 0.0))),
        (castered(5.0, 0.4, casters=1, acceleration=0.0), 1.1, 0.0, ((1.0, 1.0), (-1.0, 0.0))),
        (HEAVY, 0.0, 0.0, ((0.0, 1.5), (0.5, 0.0))),
        (robot_spec(), 0.4, 0.0, ((-0.5, 0.0), (0.5, 0.0))),
    ],
)
def test_friction_is_within_its_limit_and_adds_no_energy(world, spec, heading, degrees, commands):
    """At most mu N per contact, except for one that loses its load within the step."""
    frame = tilted_floor(world, roll=math.radians(degrees)) if degrees else None
    model = placed(world, spec, frame, heading)
    given = taken = 0.0  # [J]
    for forward, turning in commands:
        command(model, forward, turning)
        limits = kept = 0.0  # [N], sums over a second
        for _ in range(1000):
            world.run(1)
            power = 0.0
            for limit, held, of_it in touches(world, model):
                limits, power = limits + limit, power + of_it
                if limit:
                    assert held <= limit * (1.0 + 1e-6) + 1e-9
                else:
                    kept += held
            given, taken = given + 0.001 * max(power, 0.0), taken - 0.001 * min(power, 0.0)
        assert kept < 0.01 * limits
    assert given < 0.002 * taken


def soft(spec, kp):
    """Return a robot with a contact stiffness of its wheels [N/m]."""

    def softened(shape):
        if not isinstance(shape.geometry, Cylinder):
            return shape
        return replace(shape, surface=replace(shape.surface, kp=kp))

    links = (replace(one, collisions=tuple(map(softened, one.collisions))) for one in spec.links)
    return replace(spec, links=tuple(links))


@pytest.mark.parametrize(
    ('spec', 'kp', 'heading'),
    [
        (LIGHT, 1e3, 0.0),
        (LIGHT, 1e3, 0.6),
        (MIDDLE, 5e3, 0.4),
        (LIGHT, 1e5, 1.0),
    ],
)
def test_a_robot_on_soft_wheels_drives_straight(world, spec, kp, heading):
    model = placed(world, soft(spec, kp), yaw=heading)
    world.run(500)
    before = yaw_of(model.pose.orientation)
    command(model, 0.3, 0.0)
    world.run(3250)
    assert yaw_of(model.pose.orientation) == pytest.approx(before, abs=0.01)


def on_light_wheels(mass, wheel_mass, size):
    def lightened(link):
        if 'wheel' not in link.name:
            return link
        before = link.inertial
        moments = {
            key: getattr(before, key) * wheel_mass / before.mass for key in ('ixx', 'iyy', 'izz')
        }
        return replace(link, inertial=replace(before, mass=wheel_mass, **moments))

    spec = castered(mass, size, casters=1)
    return replace(spec, links=tuple(map(lightened, spec.links)))


@pytest.mark.parametrize(
    ('mass', 'wheel_mass', 'size', 'speed'),
    [
        (100.0, 0.03, 1.0, 0.22),
        (50.0, 0.05, 0.8, 0.4),
        (20.0, 0.02, 0.5, 0.1),
    ],
)
def test_heavy_body_on_light_wheels_keeps_its_speed(world, mass, wheel_mass, size, speed):
    model = placed(world, on_light_wheels(mass, wheel_mass, size))
    command(model, speed, 0.0)
    world.run(3000)
    for _ in range(300):
        world.run(7)
        assert forward_speed(model) == pytest.approx(speed, rel=0.03)


@pytest.mark.parametrize('plugins', [True, False], ids=['driven', 'bare'])
@pytest.mark.parametrize(
    ('spec', 'sunk'),
    [
        (MIDDLE, 0.1),
        (MIDDLE, 0.2),
        (LIGHT, 0.03),
        (LIGHT, 0.1),
        (HEAVY, 0.05),
        (HEAVY, 0.5),
    ],
)
def test_robot_spawned_in_the_floor_rises_without_a_jump(world, spec, sunk, plugins):
    rest = spec_height(spec) - 0.001
    model = world.spawn(
        spec if plugins else replace(spec, plugins=()), 'robot', Pose((0.0, 0.0, rest - sunk))
    )
    for _ in range(1250):
        world.run(2)
        pose, twist = model.state()
        assert twist.linear[2] <= 1.0
        assert pose.position[2] <= rest + 0.02
        assert rotate(pose.orientation, UP)[2] > 0.9
    assert model.pose.position[2] == pytest.approx(rest, abs=0.01)


@pytest.mark.parametrize(
    ('spec', 'turning'),
    [
        (robot_spec(), 1.0),
        (robot_spec(), -0.6),
        (MIDDLE, 1.5),
        (LIGHT, -1.0),
    ],
)
def test_turning_robot_stops_at_once_on_command(world, spec, turning):
    model = world.spawn(spec, 'robot', SPAWN_POSE)
    world.run(SETTLED)
    command(model, 0.0, turning)
    world.run(3210)
    command(model, 0.0, 0.0)
    plugin = next(iter(model.plugins.values()))
    ramp = abs(turning) * plugin.wheel_separation / 2.0  # at 1 m/s^2
    world.run(round(1000 * ramp) + 500)
    for _ in range(100):
        world.run(7)
        twist = model.twist
        assert math.hypot(*twist.linear) < 5e-5
        assert max(map(abs, twist.angular)) < 5e-4


def burger(mu, lean):
    """Return a small robot on two wheels and a caster with friction mu; wheels tilt by `lean`."""
    body = box('base', (0.14, 0.14, 0.05), 0.8) + ball('caster', 0.005, 0.005)
    body += (
        '<joint name="caster_joint" type="fixed"><parent link="base"/><child link="caster"/>'
        '<origin xyz="-0.06 0 -0.028"/></joint>'
    ) + surface('caster', mu)
    for side, y in (('left', 0.08), ('right', -0.08)):
        name = f'{side}_wheel'
        body += wheel(name, f'{side}_joint', 0.033, 0.018, 0.03, f'0 {y} 0').replace(
            f'rpy="{-math.pi / 2} 0 0"', f'rpy="{-math.pi / 2 + lean} 0 0"'
        )
        body += surface(name, mu)
    return urdf_spec(
        body + DRIVE_PLUGIN.format(separation=0.16, diameter=0.066, torque=10.0, acceleration=1.0)
    )


@pytest.mark.parametrize(
    ('mu', 'lean', 'turning'),
    [
        (0.1, 8e-4, 0.314),
        (0.1, 0.0, -0.314),
        (0.3, 8e-4, 1.0),
    ],
)
def test_slippery_wheels_turn_a_robot_on_the_spot_as_commanded(world, mu, lean, turning):
    model = placed(world, burger(mu, lean))
    command(model, 0.0, turning)
    world.run(SPEED_REACHED)
    assert turned(model, world, 1500) / 1.5 == pytest.approx(turning, rel=0.02)


def skid_steer(kp):
    """Return a robot of 12 kg on four wheels with a drive for each pair."""
    body = box('base', (0.5, 0.35, 0.15), 10.0)
    drives = ''
    for end, x in (('front', 0.18), ('rear', -0.18)):
        names = {}
        for side, y in (('left', 0.22), ('right', -0.22)):
            name = f'{side}_{end}'
            names[side] = f'{name}_joint'
            body += wheel(name, names[side], 0.1, 0.05, 0.5, f'{x} {y} -0.03')
            body += f'<gazebo reference="{name}"><kp>{kp}</kp></gazebo>'
        drives += (
            '<gazebo><plugin name="drive" filename="libgazebo_ros_diff_drive.so">'
            f'<leftJoint>{names["left"]}</leftJoint><rightJoint>{names["right"]}</rightJoint>'
            '<wheelSeparation>0.44</wheelSeparation><wheelDiameter>0.2</wheelDiameter>'
            '<wheelTorque>20</wheelTorque><wheelAcceleration>1.8</wheelAcceleration>'
            '<updateRate>50</updateRate></plugin></gazebo>'
        )
    return urdf_spec(body + drives)


@pytest.mark.parametrize(('kp', 'turning'), [(1e6, 1.0), (1e6, -1.0), (1e12, 1.0)])
def test_four_wheels_turn_a_robot_as_in_gazebo(world, kp, turning):
    model = world.spawn(skid_steer(kp), 'robot', Pose((0.0, 0.0, 0.131)))
    world.run(500)
    command(model, 0.0, turning)
    world.run(1000)
    assert turned(model, world, 4000) / 4.0 == pytest.approx(0.684 * turning, rel=0.05)


# A skid steer that is longer than broad, as public ones are: wheels at x = +-0.1 m, y = +-0.0875 m.
HALF_LENGTH, HALF_TRACK, WHEEL_WIDTH, SEPARATION = 0.1, 0.0875, 0.045, 0.172  # [m]


def long_skid_steer(mu):
    """Return a robot of 4.4 kg on four wheels that are further apart along x than along y."""
    body = box('base', (0.13, 0.12, 0.1), 2.37)
    for side, y in (('left', HALF_TRACK), ('right', -HALF_TRACK)):
        for end, x in (('Front', HALF_LENGTH), ('Rear', -HALF_LENGTH)):
            name = f'{side}{end}'
            body += wheel(name, f'{name}Joint', 0.045, WHEEL_WIDTH, 0.5, f'{x} {y} -0.1')
            body += surface(name, mu)
    joints = ''.join(
        f'<{name}Joint>{name}Joint</{name}Joint>'
        for name in ('leftFront', 'rightFront', 'leftRear', 'rightRear')
    )
    return urdf_spec(
        f'{body}<gazebo><plugin name="drive" filename="libgazebo_ros_skid_steer_drive.so">{joints}'
        f'<wheelSeparation>{SEPARATION}</wheelSeparation><wheelDiameter>0.09</wheelDiameter>'
        '<torque>50</torque><updateRate>100</updateRate></plugin></gazebo>'
    )


def turning_by_a_pyramid(heading):
    """Return the quasi-static rate of `long_skid_steer` on the spot at a heading, as commanded: 1.

    Each of three points of a wheel bears the same load and slides at s = (-w y - u, w x) in the
    robot's axes, u being the rim speed. Friction is mu N, against the sign of each component of s
    along the world's axes. The sum of its moments decreases with w; the rate is where it vanishes.
    """
    c, s = math.cos(heading), math.sin(heading)
    points = [
        (x, y + across)
        for x in (HALF_LENGTH, -HALF_LENGTH)
        for y in (HALF_TRACK, -HALF_TRACK)
        for across in (-WHEEL_WIDTH / 2.0, 0.0, WHEEL_WIDTH / 2.0)
    ]
    low, high = 0.0, 1.0
    while high - low > 1e-6:
        rate = (low + high) / 2.0
        moment = 0.0
        for x, y in points:
            sliding = -rate * y + math.copysign(SEPARATION / 2.0, y), rate * x
            along_x = math.copysign(1.0, c * sliding[0] - s * sliding[1])
            along_y = math.copysign(1.0, s * sliding[0] + c * sliding[1])
            moment += y * (c * along_x + s * along_y) - x * (c * along_y - s * along_x)
        low, high = (rate, high) if moment > 0.0 else (low, rate)
    return low


@pytest.mark.parametrize(
    ('degrees', 'turning'),
    [
        *((degrees, 1.0) for degrees in (0, 10, 20, 30, 45, 60, 75, 105, -60)),
        # At -w it is at the mirrored heading, a right angle less the heading.
        *((degrees, -0.5) for degrees in (0, 20, 45, 105)),
    ],
)
def test_long_skid_steer_turns_as_the_friction_pyramid_lets_it(world, degrees, turning):
    model = placed(world, long_skid_steer(0.3), yaw=math.radians(degrees))
    command(model, 0.0, turning)
    world.run(300)
    heading = yaw_of(model.pose.orientation)
    expected = heading
    for _ in range(100):
        share = turning_by_a_pyramid(math.copysign(expected, expected * turning))
        expected += turning * share / 100.0
    assert turned(model, world, 1000) == pytest.approx(expected - heading, rel=0.05, abs=0.01)


@pytest.mark.parametrize('mu', [3.0, 10.0])
def test_long_skid_steer_with_much_grip_rattles_and_turns_no_faster(world, mu):
    """Above a mu of 1 the wheels leave the ground by turns; a friction cone would give 0.42."""
    model = placed(world, long_skid_steer(mu))
    command(model, 0.0, 1.0)
    world.run(300)
    assert 0.25 < turned(model, world, 4000) / 4.0 < 0.444  # the pyramid's most, at 45 degrees


def test_four_wheels_drive_an_arc_as_in_gazebo(world):
    model = world.spawn(skid_steer(1e6), 'robot', Pose((0.0, 0.0, 0.131)))
    world.run(500)
    command(model, 0.5, 0.5)
    assert turned(model, world, 5000) == pytest.approx(1.600, rel=0.06)  # Gazebo's at 5 s
    assert forward_speed(model) == pytest.approx(0.501, rel=0.03)


@pytest.mark.parametrize('spec', [LIGHT, MIDDLE, robot_spec()], ids=['1 kg', '5 kg', 'article'])
def test_swapped_joints_drive_equally_straight(spec):
    """With left and right swapped in the tags, the robot turns the other way."""
    sides = {'leftJoint': 'rightJoint', 'rightJoint': 'leftJoint'}
    swapped = with_tags(
        spec, lambda tags: (replace(tag, tag=sides.get(tag.tag, tag.tag)) for tag in tags)
    )
    yaws = []
    for one in (spec, swapped):
        with empty_world() as world:
            model = world.spawn(one, 'robot', SPAWN_POSE)
            world.run(SETTLED)
            command(model, 0.3, 0.0)
            world.run(2000)
            yaws.append(yaw_of(model.pose.orientation))
    assert yaws[0] == pytest.approx(yaws[1], abs=5e-4)


def axle_angle(transform):
    """Return the rotation of a wheel's transform about its axle [rad], in (-pi, pi]."""
    x, y, z, w = transform.pose.orientation
    back = from_rpy(math.pi / 2.0, 0.0, 0.0)
    x, y, z, w = compose(Pose(orientation=back), Pose(orientation=(x, y, z, w))).orientation
    return 2.0 * math.atan2(z, w)


@pytest.mark.parametrize('spec', [LIGHT, MIDDLE])
@pytest.mark.parametrize('driven', [(0.3, 0.0), (0.2, -0.7)])
def test_wheel_angles_of_transform_joint_states_and_odometry_agree(world, spec, driven):
    tags = {'odometrySource': 'encoder', 'publishWheelTF': 'true', 'publishWheelJointState': 'true'}
    added = [Element(tag, text) for tag, text in tags.items()]
    model = placed(world, with_tags(spec, lambda given: (*given, *added)))
    drive = next(iter(model.plugins.values()))
    told = {}
    for output in (drive.joint_states, drive.wheel_transform, drive.odometry):
        output.connect(lambda reading: told.setdefault(type(reading), []).append(reading))
    start = [wheel.position for wheel in drive.wheels]
    drive.reset()
    command(model, *driven)
    world.run(drive.due - world.clock.steps + 3000)
    left, right = (wheel.position for wheel in drive.wheels)
    states = told[JointStates][-1]
    assert states.positions == pytest.approx((right, left), abs=1e-9)
    for transform, angle in zip(told[FrameTransform][-2:], (left, right), strict=True):
        apart = math.remainder(axle_angle(transform) - angle, math.tau)
        assert abs(apart) < 1e-9
    ways = [
        (now - then) * drive.wheel_diameter / 2.0
        for now, then in zip((left, right), start, strict=True)
    ]
    turn = (ways[1] - ways[0]) / drive.wheel_separation
    yaw = yaw_of(told[Odometry][-1].pose.orientation)
    assert math.remainder(yaw - turn, math.tau) == pytest.approx(0.0, abs=1e-9)
