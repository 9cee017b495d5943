"""Scenes in which Gazebo's sensors were recorded, and the recordings."""

import json
import math

import numpy as np

from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.public.world import World

from . import ROOT

RECORDED = ROOT / 'test' / 'data' / 'gazebo'
ROBOTS = RECORDED / 'sensors' / 'robots'
# Pose of the laser in all recorded robots, in the model's frame: position [m], yaw [rad].
LASER, HEADING = (0.12, 0.03, 0.35), 0.1
CUBE = (
    '<sdf version="1.6"><model name="cube"><static>1</static><link name="l">'
    '<collision name="c"><geometry><box><size>.02 .02 .02</size></box></geometry>'
    '</collision></link></model></sdf>'
)


def recordings(name):
    """Return the recordings of a type of sensor, by name of the scene."""
    return json.loads((RECORDED / 'sensors' / f'{name}.json').read_text(encoding='utf-8'))


def numbers(values):
    """Return recorded numbers as an array; inf and nan are recorded as text."""
    return np.array([float(value) for value in values])


def pose_of(recording):
    """Return the recorded pose of the model."""
    return Pose(tuple(recording['position']), tuple(recording['orientation']))


def recorded_scene(recording):
    """Return the recorded world and its robot; the caller closes the world."""
    world = World.from_file(RECORDED / 'worlds' / 'scene_a.world')
    robot = world.spawn(ROBOTS / f'{recording["robot"]}.urdf', 'robot', pose_of(recording))
    if 'near' in recording:
        x, y, z = LASER
        middle = recording['near'] + 0.01
        # The six digits that were given to spawn_model decide where a ray begins at its surface.
        world.spawn(
            CUBE,
            x=round(x + middle * math.cos(HEADING), 6),
            y=round(y + middle * math.sin(HEADING), 6),
            z=z,
            yaw=HEADING,
        )
    return world, robot
