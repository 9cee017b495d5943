"""A diff drive without an engine: a model of two wheel joints that obey at once, or as told."""

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


class FakeModel:
    """A model with two wheels and a pose that a test can set."""

    def __init__(self, wheel_collisions=()):
        self.name = 'robot'
        self.wheels = {'left': Wheel('left', self), 'right': Wheel('right', self)}
        self.now = (Pose(), Twist())
        y = {'left': 0.4, 'right': -0.4}
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
