"""Scenes in which images of Gazebo's cameras were recorded, and the images."""

from dataclasses import replace

import numpy as np
from PIL import Image

from rosbots_description.sim.core.transforms import Pose, from_rpy
from rosbots_description.sim.public.world import World

from .sensing import RECORDED, robot_text

FILES = RECORDED / 'sensors' / 'pictures'


def recorded_picture(name):
    """Return an image (height, width, channels) as signed integers, for differences."""
    pixels = np.asarray(Image.open(FILES / f'{name}.png')).astype(int)
    return pixels.reshape(*pixels.shape[:2], -1)


def recorded_world(name='scene_a', shadows=False):
    """Return a world, without shadows as in the recorded images; the caller closes it."""
    world = World.from_file(RECORDED / 'worlds' / f'{name}.world')
    world.scene = replace(world.scene, shadows=shadows)
    return world


def spawn_robot(world, robot, x=0.0, yaw=0.0):
    """Spawn a recorded robot; return its model and its camera."""
    model = world.spawn(robot_text(robot), 'robot', Pose((x, 0.0, 0.0), from_rpy(0.0, 0.0, yaw)))
    return model, next(iter(model.sensors.values()))
