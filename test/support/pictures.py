"""Scenes in which Gazebo's cameras were recorded, to do again here."""

from dataclasses import replace

import numpy as np
from PIL import Image

from rosbots_description.sim.core.transforms import Pose, from_rpy
from rosbots_description.sim.public.world import World

from .sensing import RECORDED, ROBOTS

FILES = RECORDED / 'sensors' / 'pictures'


def recorded_picture(name):
    """Return a picture (height, width, channels) as integers that may be subtracted."""
    pixels = np.asarray(Image.open(FILES / f'{name}.png')).astype(int)
    return pixels.reshape(*pixels.shape[:2], -1)


def recorded_world(name='scene_a', shadows=False):
    """Return a world; the pictures were recorded where no shadows could be drawn. Close it."""
    world = World.from_file(RECORDED / 'worlds' / f'{name}.world')
    world.scene = replace(world.scene, shadows=shadows)
    return world


def spawn_robot(world, robot, x=0.0, yaw=0.0):
    """Return a robot in the world, and its camera."""
    text = (ROBOTS / f'{robot}.urdf').read_text(encoding='utf-8')
    model = world.spawn(text, 'robot', Pose((x, 0.0, 0.0), from_rpy(0.0, 0.0, yaw)))
    return model, model.sensors[0]
