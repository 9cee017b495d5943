"""Scenes in which Gazebo's sensors were recorded, to do again here."""

import json
import math

import numpy as np

from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.public.world import World

from . import ROOT

RECORDED = ROOT / 'test' / 'data' / 'gazebo'
ROBOTS = RECORDED / 'sensors' / 'robots'
# Where the laser of all recorded robots is, in their model: position [m], yaw [rad].
LASER, HEADING = (0.12, 0.03, 0.35), 0.1
CUBE = ('<sdf version="1.6"><model name="cube"><static>1</static><link name="l">'
        '<collision name="c"><geometry><box><size>.02 .02 .02</size></box></geometry>'
        '</collision></link></model></sdf>')


def recordings(name):
    """Return what was recorded of a kind of sensor, by the name of the scene."""
    return json.loads((RECORDED / 'sensors' / f'{name}.json').read_text(encoding='utf-8'))


def numbers(values):
    """Return recorded numbers, of which inf and nan are words."""
    return np.array([float(value) for value in values])


def pose_of(recording):
    """Return where the model was."""
    return Pose(tuple(recording['position']), tuple(recording['orientation']))


def recorded_scene(recording):
    """Return a world and the robot in it, both as they were recorded; close the world."""
    world = World.from_file(RECORDED / 'worlds' / 'scene_a.world')
    robot = world.spawn(ROBOTS / f'{recording["robot"]}.urdf', 'robot', pose_of(recording))
    if 'near' in recording:
        x, y, z = LASER
        middle = recording['near'] + 0.01
        # The six digits that were given to spawn_model decide where a ray begins at its surface.
        world.spawn(CUBE, x=round(x + middle * math.cos(HEADING), 6),
                    y=round(y + middle * math.sin(HEADING), 6), z=z, yaw=HEADING)
    return world, robot
