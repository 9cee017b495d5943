"""Scenes with a known analytic result; each returns the error against it.

The engine's settings were chosen by these (benchmark/physics.py); tests bound the errors.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from rosbots_description.sim.core.transforms import Pose, Twist, compose, from_rpy, rotate, yaw_of
from rosbots_description.sim.description.model_spec import Element, ModelSpec, Sphere
from rosbots_description.sim.physics.bullet.tuning import Tuning
from rosbots_description.sim.runtime.model import Model
from rosbots_description.sim.runtime.world import World

from . import SETTLED, empty_world, robot_spec, urdf_spec

GRAVITY = 9.8  # [m/s^2]
SPEED = 0.5  # [m/s] commanded
HEADINGS = (0.0, 0.4, math.pi / 4.0, 1.0)  # [rad] of straight drives
ABOVE = 1e-3  # clearance at spawn [m]
RADIUS = 0.1  # of the skid steer's wheels [m]
DRIVE_PLUGIN = (
    '<gazebo><plugin name="drive" filename="libgazebo_ros_diff_drive.so">'
    '<leftJoint>left_joint</leftJoint><rightJoint>right_joint</rightJoint>'
    '<wheelSeparation>{separation}</wheelSeparation><wheelDiameter>{diameter}</wheelDiameter>'
    '<wheelTorque>{torque}</wheelTorque><wheelAcceleration>{acceleration}</wheelAcceleration>'
    '</plugin></gazebo>'
)

Scene = Callable[..., float]  # of a Tuning, by default none; a veer takes seconds, too


def link(name: str, shape: str, mass: float, inertia: tuple[float, float, float]) -> str:
    """Return a link with one shape: mass [kg], moments of inertia about x, y and z [kg m^2]."""
    ixx, iyy, izz = inertia
    return (
        f'<link name="{name}"><inertial><mass value="{mass}"/><inertia ixx="{ixx}" '
        f'iyy="{iyy}" izz="{izz}" ixy="0" ixz="0" iyz="0"/></inertial>'
        f'<collision><geometry>{shape}</geometry></collision></link>'
    )


def box(name: str, size: tuple[float, float, float], mass: float) -> str:
    """Return a link that is a solid box: size [m], mass [kg]."""
    x, y, z = size
    inertia = tuple(mass / 12.0 * s for s in (y * y + z * z, x * x + z * z, x * x + y * y))
    return link(name, f'<box size="{x} {y} {z}"/>', mass, inertia)


def ball(name: str, radius: float, mass: float) -> str:
    """Return a link that is a solid ball: radius [m], mass [kg]."""
    return link(name, f'<sphere radius="{radius}"/>', mass, (0.4 * mass * radius**2,) * 3)


def wheel(name: str, joint: str, radius: float, width: float, mass: float, place: str) -> str:
    """Return a wheel on a joint at `place` [m] in the frame of `base`; positive is forward.

    Radius and width are in m, the mass in kg.
    """
    across = mass * (3.0 * radius**2 + width**2) / 12.0
    shape = f'<cylinder radius="{radius}" length="{width}"/>'
    about = f'{-math.pi / 2} 0 0'
    return (
        link(name, shape, mass, (across, across, mass * radius**2 / 2.0))
        + f'<joint name="{joint}" type="continuous"><parent link="base"/><child link="{name}"/>'
        f'<origin xyz="{place}" rpy="{about}"/><axis xyz="0 0 1"/></joint>'
    )


def surface(link_name: str, mu: float) -> str:
    """Return the tags for the friction of a link."""
    return f'<gazebo reference="{link_name}"><mu1>{mu}</mu1><mu2>{mu}</mu2></gazebo>'


def castered(
    mass: float = 5.0,
    size: float = 0.4,
    casters: int = 2,
    mu: float = 1.0,
    acceleration: float = 1.0,
    torque: float = 1.0,
    rear: float = 0.0,
) -> ModelSpec:
    """Return a symmetric robot on two wheels and one caster (rear) or two (rear, front).

    Args:
        mass: total [kg].
        size: length of the body [m]; all lengths scale with it.
        casters: 1 or 2.
        mu: friction of the casters.
        acceleration: limit at the rims [m/s^2]; 0 for none.
        torque: limit of each motor, as a multiple of mass * g * wheel radius.
        rear: centre of mass of the body, as a fraction of the way from the axle to the rear caster.
    """
    radius = size / 4.0
    caster = radius / 3.0
    height = radius  # of the body's centre above the ground
    body = box('base', (size, 0.7 * size, radius), 0.8 * mass).replace(
        '<inertial>', f'<inertial><origin xyz="{-0.4 * size * rear} 0 0"/>'
    )
    for k, x in enumerate((-0.4 * size, 0.4 * size)[:casters]):
        # A sphere fixed to the body: it slides, as the article's caster does.
        body += ball(f'caster{k}', caster, 0.02 * mass)
        body += (
            f'<joint name="caster{k}_joint" type="fixed"><parent link="base"/>'
            f'<child link="caster{k}"/><origin xyz="{x} 0 {caster - height}"/></joint>'
        )
        body += surface(f'caster{k}', mu)
    for side, y in (('left', 0.4 * size), ('right', -0.4 * size)):
        body += wheel(f'{side}_wheel', f'{side}_joint', radius, 0.1 * size, 0.08 * mass, f'0 {y} 0')
    body += DRIVE_PLUGIN.format(
        separation=0.8 * size,
        diameter=2.0 * radius,
        torque=torque * mass * GRAVITY * radius,
        acceleration=acceleration,
    )
    return urdf_spec(body)


def tilted_floor(world: World, roll: float = 0.0, pitch: float = 0.0) -> Pose:
    """Replace the ground by a large board tilted by angles [rad]; return its upper frame."""
    tilt = from_rpy(roll, pitch, 0.0)
    board = replace(urdf_spec(box('board', (60.0, 60.0, 1.0), 1.0)), static=True)
    world.delete('ground_plane')
    world.spawn(board, 'board', Pose(rotate(tilt, (0.0, 0.0, -0.5)), tilt))
    return Pose(orientation=tilt)


def with_tags(
    spec: ModelSpec, change: Callable[[Sequence[Element]], Iterable[Element]]
) -> ModelSpec:
    """Return a model whose only plugin has other tags."""
    (plugin,) = spec.plugins
    element = replace(plugin.element, children=tuple(change(plugin.element.children)))
    return replace(spec, plugins=(replace(plugin, element=element),))


def forward_speed(model: Model) -> float:
    """Return the velocity along the model's x axis [m/s]."""
    pose, ((vx, vy, _), _) = model.state()
    yaw = yaw_of(pose.orientation)
    return math.cos(yaw) * vx + math.sin(yaw) * vy


def drive(
    world: World, spec: ModelSpec, seconds: int = 4, yaw: float = 0.0, speed: float = SPEED
) -> Model:
    """Return the model after a straight drive of `seconds` from heading `yaw` [rad].

    Args:
        speed: commanded [m/s].
    """
    place = Pose((0.0, 0.0, spec_height(spec)), from_rpy(0.0, 0.0, yaw))
    model = world.spawn(spec, 'robot', place)
    world.run(SETTLED)
    next(iter(model.plugins.values())).command(speed, 0.0)
    world.run(1000 * seconds)
    return model


def spec_height(spec: ModelSpec) -> float:
    """Return the spawn height of a robot whose last link is a wheel [m]."""
    wheel = spec.links[-1]
    return wheel.collisions[0].geometry.radius - wheel.pose.position[2] + ABOVE


def speed_error(spec: ModelSpec) -> Scene:
    """Return a scene: relative error of a robot's speed."""

    def scene(tuning: Tuning | None = None) -> float:
        with empty_world(tuning) as world:
            return abs(forward_speed(drive(world, spec)) / SPEED - 1.0)

    return scene


def heading_error(spec: ModelSpec) -> Scene:
    """Return a scene: relative spread of a robot's speed over headings."""

    def speed(yaw: float, tuning: Tuning | None) -> float:
        with empty_world(tuning) as world:
            return forward_speed(drive(world, spec, 4, yaw))

    def scene(tuning: Tuning | None = None) -> float:
        speeds = [speed(yaw, tuning) for yaw in HEADINGS]
        return max(speeds) / min(speeds) - 1.0

    return scene


def veer(spec: ModelSpec, speed: float = SPEED) -> Scene:
    """Return a scene: largest heading drift in a straight drive, by default of 20 s [rad]."""

    def turned(yaw: float, tuning: Tuning | None, seconds: int) -> float:
        with empty_world(tuning) as world:
            return abs(yaw_of(drive(world, spec, seconds, yaw, speed).pose.orientation) - yaw)

    return lambda tuning=None, seconds=20: max(turned(yaw, tuning, seconds) for yaw in HEADINGS)


def mirrored(spec: ModelSpec) -> ModelSpec:
    """Return the article's robot with symmetric wheels and caster.

    The wheels are broad; the sliding caster carries a sixth of the weight.
    """

    def centred(pose: Pose) -> Pose:
        x, _, z = pose.position
        return Pose((x, 0.0, z), pose.orientation)

    base, *wheels = spec.links
    links = [
        replace(
            base,
            inertial=replace(base.inertial, pose=centred(base.inertial.pose)),
            collisions=tuple(
                replace(one, pose=centred(one.pose)) if isinstance(one.geometry, Sphere) else one
                for one in base.collisions
            ),
        )
    ]
    for link, side in zip(wheels, (1.0, -1.0), strict=True):
        x, _, z = link.pose.position
        links.append(
            replace(
                link,
                pose=Pose((x, 0.44 * side, z), from_rpy(-math.pi / 2, 0.0, 0.0)),
                inertial=replace(link.inertial, pose=Pose()),
                collisions=tuple(replace(one, pose=Pose()) for one in link.collisions),
            )
        )
    return replace(spec, links=tuple(links))


def skid_steer(mass: float = 14.0) -> ModelSpec:
    """Return a robot of a mass [kg] on four driven wheels, without a plugin."""
    body = box('base', (0.5, 0.3, 0.1), 0.7 * mass)
    for side, y in (('left', 0.2), ('right', -0.2)):
        for end, x in (('front', 0.15), ('rear', -0.15)):
            name = f'{side}_{end}'
            body += wheel(name, f'{name}_joint', RADIUS, 0.05, 0.075 * mass, f'{x} {y} 0')
    return urdf_spec(body)


def skid(world: World, left: float, right: float, seconds: float) -> Model:
    """Return the skid steer after `seconds` at left and right rim speeds [m/s]."""
    model = world.spawn(skid_steer(), 'robot', Pose((0.0, 0.0, RADIUS)))
    for name, joint in model.joints.items():
        joint.set_motor((left if name.startswith('left') else right) / RADIUS, 20.0)
    world.run(round(1000 * seconds))
    return model


def skid_straight(tuning: Tuning | None = None) -> float:
    """Return the relative error of the speed of a skid steer that drives straight."""
    with empty_world(tuning) as world:
        return abs(forward_speed(skid(world, SPEED, SPEED, 4.0)) / SPEED - 1.0)


def skid_turn(tuning: Tuning | None = None) -> float:
    """Return the yaw rate of a skid steer turning on the spot, relative to that without slip."""
    with empty_world(tuning) as world:
        model = skid(world, -SPEED, SPEED, 1.0)
        turned = 0.0
        for _ in range(300):
            world.run(10)
            turned += model.twist.angular[2] * 0.01
        return turned / 3.0 / (2.0 * SPEED / 0.4)


def step_climbed(tuning: Tuning | None = None) -> float:
    """Return how far short of 2 m a skid steer is after 5 s with a step of 3 cm on its way [m]."""
    with empty_world(tuning) as world:
        ledge = replace(urdf_spec(box('ledge', (4.0, 2.0, 0.03), 1.0)), static=True)
        world.spawn(ledge, 'ledge', Pose((2.5, 0.0, 0.015)))
        return max(0.0, 2.0 - skid(world, SPEED, SPEED, 5.0).pose.position[0])


def slope(world: World, degrees: float = 10.0) -> Pose:
    """Spawn a large board tilted about y; return the frame of its upper face, x downhill."""
    board = replace(urdf_spec(box('board', (40.0, 10.0, 1.0), 1.0)), static=True)
    tilt = from_rpy(0.0, math.radians(degrees), 0.0)
    s, c = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    world.delete('ground_plane')
    world.spawn(board, 'board', Pose((-0.5 * s, 0.0, -0.5 * c), tilt))
    return Pose((0.0, 0.0, 0.0), tilt)


def on_slope(frame: Pose, height: float) -> Pose:
    """Return the pose of a body whose centre is `height` [m] above the board."""
    return compose(frame, Pose((0.0, 0.0, height)))


def parked_on_slope(spec: ModelSpec) -> Scene:
    """Return a scene: drift of a parked robot in 10 s on a slope of 10 degrees [m]."""

    def scene(tuning: Tuning | None = None) -> float:
        with empty_world(tuning) as world:
            model = world.spawn(spec, 'robot', on_slope(slope(world), 0.1))
            world.run(1000)
            before = model.pose.position
            world.run(10_000)
            return math.dist(before, model.pose.position)

    return scene


def sliding_on_slope(tuning: Tuning | None = None) -> float:
    """Return the relative error of a sliding acceleration: g (sin 10° - mu cos 10°), mu 0.1."""
    with empty_world(tuning) as world:
        spec = urdf_spec(box('box', (0.2, 0.2, 0.1), 2.0) + surface('box', 0.1))
        model = world.spawn(spec, 'box', on_slope(slope(world), 0.05))
        world.run(200)
        before = model.twist.linear
        world.run(1000)
        gained = math.dist(before, model.twist.linear)
        tilt = math.radians(10.0)
        return abs(gained / (GRAVITY * (math.sin(tilt) - 0.1 * math.cos(tilt))) - 1.0)


def stack(tuning: Tuning | None = None) -> float:
    """Return how far the topmost of five stacked boxes has moved after 10 s [m]."""
    with empty_world(tuning) as world:
        spec = urdf_spec(box('box', (0.2, 0.2, 0.2), 1.0))
        for k in range(5):
            model = world.spawn(spec, f'box{k}', Pose((0.0, 0.0, 0.1 + 0.2 * k)))
        world.run(10_000)
        return math.dist(model.pose.position, (0.0, 0.0, 0.9))


def half_sunk(tuning: Tuning | None = None) -> float:
    """Return how high a box jumps above rest that is spawned half inside the ground [m]."""
    with empty_world(tuning) as world:
        model = world.spawn(urdf_spec(box('box', (0.2, 0.2, 0.2), 1.0)), 'box', Pose())
        highest = 0.0
        for _ in range(300):
            world.run(10)
            highest = max(highest, model.pose.position[2])
        return highest - 0.1


def rolling_ball(tuning: Tuning | None = None) -> float:
    """Return the relative error of the final speed of a ball that slides at 1 m/s: 5/7 m/s."""
    with empty_world(tuning) as world:
        model = world.spawn(urdf_spec(ball('ball', 0.1, 1.0)), 'ball', Pose((0.0, 0.0, 0.1)))
        world.run(100)
        model.set_twist(Twist((1.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
        world.run(3000)
        return abs(math.hypot(*model.twist.linear[:2]) * 7.0 / 5.0 - 1.0)


def lying_can(tuning: Tuning | None = None) -> float:
    """Return how far a can lying oblique to the axes drifts in 10 s [m]."""
    with empty_world(tuning) as world:
        can = urdf_spec(
            link('can', '<cylinder radius="0.033" length="0.12"/>', 0.39, (5.6e-4, 5.6e-4, 1.7e-4))
        )
        model = world.spawn(can, 'can', Pose((0.0, 0.0, 0.034), from_rpy(math.pi / 2.0, 0.0, 0.4)))
        world.run(SETTLED)
        start = model.pose.position
        world.run(10_000)
        return math.dist(start, model.pose.position)


# Relative errors, or lengths where marked; a veer is the heading drift in 20 s [rad]. All are best
# at 0, except for `skid steer turns`.
SCENES: dict[str, Scene] = {
    'one dragging caster': speed_error(castered(casters=1)),
    'two casters, mu 1': speed_error(castered(mu=1.0)),
    'two casters, mu 0.1': speed_error(castered(mu=0.1)),
    '50 kg': speed_error(castered(50.0, 1.0, casters=1)),
    '0.2 kg': speed_error(castered(0.2, 0.12, casters=1)),
    'speed, any heading': heading_error(castered(casters=1, rear=0.4)),
    'veer, one caster': veer(castered(casters=1)),
    'veer, laden caster': veer(castered(casters=1, rear=0.4)),
    'veer, two casters': veer(castered()),
    'veer, 0.2 kg': veer(castered(0.2, 0.12, casters=1)),
    'veer, broad wheels': veer(mirrored(robot_spec())),
    "veer, the article's": veer(robot_spec()),
    'skid steer straight': skid_straight,
    'skid steer turns': skid_turn,
    'step of 3 cm [m]': step_climbed,
    'parked on casters [m]': parked_on_slope(castered()),
    'parked on wheels [m]': parked_on_slope(castered(casters=1, mu=0.0)),
    'slides on 10 deg': sliding_on_slope,
    'five boxes [m]': stack,
    'half sunk box [m]': half_sunk,
    'ball rolls': rolling_ball,
    'can lies [m]': lying_can,
}
