"""Plugins on robots without physics: a real world and model on a fake engine."""

import math

from rosbots_description.sim.core.transforms import Pose, Twist, from_rpy
from rosbots_description.sim.description.model_spec import (
    Collision,
    Cylinder,
    Element,
    JointSpec,
    LinkSpec,
    ModelSpec,
    PluginSpec,
)
from rosbots_description.sim.plugins.drive.diff_drive import DiffDrive
from rosbots_description.sim.runtime.world import World

from .fake_engine import FakeEngine

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


def fake_model(wheel_collisions=(), names=('left', 'right')):
    """Return a model with wheels in a new world; left ones are at y = 0.4 m, right ones at -0.4."""
    side = from_rpy(-math.pi / 2, 0.0, 0.0)
    links = [
        LinkSpec(
            f'{name}_link',
            Pose((0.1, -0.4 if 'right' in name else 0.4, 0.2), side),
            collisions=wheel_collisions,
        )
        for name in names
    ]
    joints = tuple(JointSpec(name, 'revolute', 'base', f'{name}_link') for name in names)
    world = World(make_engine=FakeEngine)
    model = world.spawn(ModelSpec('robot', (LinkSpec('base'), *links), joints), 'robot', Pose())
    model.world = world
    return model


def load_plugin(plugin_class, model, element):
    """Return a plugin of the model, loaded with the tags of an element."""
    spec = PluginSpec('drive', 'libgazebo_ros_drive.so', element)
    plugin = plugin_class(model.world, model, spec)
    plugin.start()
    model.plugins[plugin.name] = plugin
    model.world.schedule.add(plugin)
    return plugin


def make(wheel_collisions=(), **tags):
    """Return a loaded diff drive with TAGS and these tags; a tag that is None is left out."""
    return make_drive(DiffDrive, fake_model(wheel_collisions), **(TAGS | tags))


def make_drive(plugin_class, model, **tags):
    """Return a loaded plugin of the model with these tags; a tag that is None is left out."""
    children = tuple(Element(tag, text) for tag, text in tags.items() if text is not None)
    return load_plugin(plugin_class, model, Element('plugin', children=children))


def run(plugin, steps):
    """Advance the plugin's world."""
    plugin.world.run(steps)


def place(plugin, pose, twist=None):
    """Set pose and twist of the plugin's model."""
    plugin.model.set_pose(pose)
    plugin.model.set_twist(twist or Twist())


def turn(plugin, **speeds):
    """Set velocities of joints [rad/s], whatever their motor targets."""
    for joint, speed in speeds.items():
        plugin.model.body.state[joint][1] = speed


def rim_speeds(plugin):
    """Return the rim speeds of the wheels, left and right [m/s]."""
    return tuple(
        joint.velocity * plugin.wheel_diameter / 2 for joint in plugin.model.joints.values()
    )


def collect(output):
    """Return a list to which the output appends its readings."""
    readings = []
    output.connect(readings.append)
    return readings


def wheel_of(radius):
    """Return the collisions of a wheel of a radius [m]."""
    return (Collision('c', Cylinder(radius, 0.2)),)
