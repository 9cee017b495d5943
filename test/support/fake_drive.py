"""A diff drive without an engine: a model of two wheel joints that obey at once, or as told."""

import math
from functools import partial
from types import SimpleNamespace

from rosbots_description.sim.clock import SimClock
from rosbots_description.sim.errors import NotFoundError
from rosbots_description.sim.plugins.diff_drive import DiffDrive
from rosbots_description.sim.pose import Pose, Twist, compose, from_rpy
from rosbots_description.sim.spec import (
    Collision,
    Cylinder,
    Element,
    Inertial,
    JointSpec,
    LinkSpec,
    ModelSpec,
    PluginSpec,
)
from rosbots_description.sim.tuning import Tuning

TAGS = {
    'robotNamespace': '/',
    'leftJoint': 'left',
    'rightJoint': 'right',
    'wheelSeparation': '1.1',
    'wheelDiameter': '0.52',
    'wheelAcceleration': '1.0',
    'updateRate': '100',
}
STEP = 0.001  # [s]
BASE = Inertial(4.0, ixx=0.1, iyy=0.1, izz=0.2)
WHEEL = Inertial(0.5, ixx=0.01, iyy=0.01, izz=0.01)
PERIOD_STEPS = 10


class Wheel:
    """A joint that turns at its motor's target from the moment it is told."""

    def __init__(self, name, model):
        self.name, self.model = name, model
        self.spec = JointSpec(name, 'revolute', 'base', f'{name}_link')
        self.position, self.velocity, self.effort = 0.0, 0.0, 0.0
        self.weight = 0.0  # [N]; nothing rests on a wheel of these tests unless they say so
        self.gives = None  # what comes of the speed asked for: speed and effort

    def set_motor(self, velocity, effort):
        self.velocity, self.effort = self.gives(velocity) if self.gives else (velocity, effort)

    def normal_force(self):
        return self.weight


class FakeModel:
    """A model with two wheels and a pose that a test can set."""

    def __init__(self, wheel_collisions=()):
        self.name = 'robot'
        self.wheels = {'left': Wheel('left', self), 'right': Wheel('right', self)}
        self.now = (Pose(), Twist())
        y = {'left': 0.4, 'right': -0.4}
        self.ground = self.aside = 0.0  # [m/s] at which it drives along x, and is moved along y
        self.turns = 0.0  # [rad/s] about the middle between the wheels
        self.radius = wheel_collisions[0].geometry.radius if wheel_collisions else 0.0
        side = from_rpy(-math.pi / 2, 0.0, 0.0)
        wheel_links = [
            LinkSpec(
                f'{name}_link', Pose((0.0, y[name], 0.2), side), WHEEL, collisions=wheel_collisions
            )
            for name in y
        ]
        self.spec = ModelSpec('robot', (LinkSpec('base', inertial=BASE), *wheel_links))
        self.links = {
            link.name: SimpleNamespace(
                pose=Pose((0.1, *link.pose.position[1:])), state=partial(self.link_state, link)
            )
            for link in self.spec.links
        }
        self.body = None
        self.rolling = set()  # links that were let to roll
        self.holds = {}  # which shares of its friction each link holds
        self.contacts = {}  # with what links touch
        self.pushes = []  # what the base was pushed with: force and torque
        self.engine = SimpleNamespace(
            set_hold=lambda _, link, axis, hold: self.holds.__setitem__(link, hold),
            contacts=lambda _, link: self.contacts.get(link, []),
            push=lambda _, link, force, torque, place: self.pushes.append((force, torque)),
            friction_towards=Tuning().friction_towards,
            let_sink=lambda *_: None,
            let_roll=lambda _, link: self.rolling.add(link),
        )

    def state(self):
        return self.now

    def link_state(self, link):
        """Return where a link is as it drives through the origin, and its twist."""
        name = link.name.removesuffix('_link')
        spins = self.wheels[name].velocity if name in self.wheels else 0.0
        linear = (self.ground - self.turns * link.pose.position[1], self.aside, 0.0)
        return link.pose, Twist(linear, (0.0, spins, self.turns))

    @property
    def pose(self):
        """Return where it is by `now`, turned as its wheels have turned it."""
        left, right = (self.wheels[side].position * self.radius for side in ('left', 'right'))
        told = from_rpy(0.0, 0.0, (right - left) / 0.8)
        return compose(self.now[0], Pose((0.0, 0.0, 0.0), told))

    def joint(self, name):
        if name not in self.wheels:
            raise NotFoundError(f"model 'robot' has no joint '{name}'; its joints: left, right")
        return self.wheels[name]


def make(wheel_collisions=(), **tags):
    """Return a loaded plugin with these tags beside TAGS; one that is None is left out."""
    children = tuple(Element(tag, text) for tag, text in (TAGS | tags).items() if text is not None)
    spec = PluginSpec('drive', 'libgazebo_ros_diff_drive.so', Element('plugin', children=children))
    world = SimpleNamespace(clock=SimClock(STEP))
    plugin = DiffDrive(world, FakeModel(wheel_collisions), spec)
    plugin.load()
    return plugin


def run(plugin, steps):
    """Advance like the world does: time first, then the hook if it is due."""
    clock = plugin.world.clock
    for _ in range(steps):
        clock.steps += 1
        for wheel in plugin.model.wheels.values():
            wheel.position += wheel.velocity * STEP
        if plugin.due <= clock.steps:
            plugin.update()


def rim_speeds(plugin):
    """Return what the joints make of the rims, left and right [m/s]."""
    wheels = plugin.model.wheels
    return tuple(wheels[side].velocity * plugin.config.wheel_diameter / 2 for side in wheels)


def collect(port):
    """Return a list that gets what the port sends."""
    readings = []
    port.connect(readings.append, lambda: True)
    return readings


def wheel_of(radius):
    """Return the collisions of a wheel of that radius [m]."""
    return (Collision('c', Cylinder(radius, 0.2)),)
