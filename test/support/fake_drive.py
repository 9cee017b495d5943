"""Drives without an engine: a model of joints that obey at once, or as told."""

import math
from types import SimpleNamespace

from rosbots_description.sim.clock import SimClock
from rosbots_description.sim.errors import NotFoundError
from rosbots_description.sim.plugins.diff_drive import DiffDrive
from rosbots_description.sim.pose import Pose, Twist, from_rpy
from rosbots_description.sim.spec import (
    Collision,
    Cylinder,
    Element,
    JointSpec,
    LinkSpec,
    ModelSpec,
    PluginSpec,
)

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
PERIOD_STEPS = 10


class Wheel:
    """A joint that turns at its motor's target from the moment it is told."""

    def __init__(self, name, model):
        self.name, self.model = name, model
        self.spec = JointSpec(name, 'revolute', 'base', f'{name}_link')
        self.position, self.velocity, self.effort = 0.0, 0.0, 0.0

    def set_motor(self, velocity, effort):
        self.velocity, self.effort = velocity, effort

    def set_position(self, position):
        self.position, self.velocity = position, 0.0

    def state(self):
        return self.position, self.velocity


class FakeModel:
    """A model with wheels and a pose that a test can set."""

    def __init__(self, wheel_collisions=(), names=('left', 'right')):
        self.name = 'robot'
        self.wheels = {name: Wheel(name, self) for name in names}
        self.now = (Pose(), Twist())
        y = {name: -0.4 if 'right' in name else 0.4 for name in names}
        side = from_rpy(-math.pi / 2, 0.0, 0.0)
        wheel_links = [
            LinkSpec(f'{name}_link', Pose((0.0, y[name], 0.2), side), collisions=wheel_collisions)
            for name in y
        ]
        self.spec = ModelSpec('robot', (LinkSpec('base'), *wheel_links))
        self.links = {
            link.name: SimpleNamespace(pose=Pose((0.1, *link.pose.position[1:])))
            for link in self.spec.links
        }

    def state(self):
        return self.now

    @property
    def pose(self):
        return self.now[0]

    def set_twist(self, twist):
        self.now = (self.pose, twist)

    def joint(self, name):
        if name not in self.wheels:
            known = ', '.join(self.wheels)
            raise NotFoundError(f"model 'robot' has no joint '{name}'; its joints: {known}")
        return self.wheels[name]


def make(wheel_collisions=(), **tags):
    """Return a loaded diff drive with these tags beside TAGS; one that is None is left out."""
    return make_drive(DiffDrive, FakeModel(wheel_collisions), **(TAGS | tags))


def make_drive(plugin_class, model, **tags):
    """Return a loaded plugin of that model with these tags; one that is None is left out."""
    children = tuple(Element(tag, text) for tag, text in tags.items() if text is not None)
    spec = PluginSpec('drive', 'libgazebo_ros_drive.so', Element('plugin', children=children))
    plugin = plugin_class(SimpleNamespace(clock=SimClock(STEP)), model, spec)
    plugin.load()
    return plugin


def run(plugin, steps):
    """Advance like the world does: time, the hook if it is due, physics, its report."""
    clock = plugin.world.clock
    for _ in range(steps):
        clock.steps += 1
        due = plugin.due <= clock.steps
        if due:
            plugin.update()
        for wheel in plugin.model.wheels.values():
            wheel.position += wheel.velocity * STEP
        if due:
            plugin.observe()


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
