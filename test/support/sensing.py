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


def robot_text(name, old='', new=''):
    """Return the URDF of a recorded robot, with another text in place of one that it has."""
    file = ROBOTS / f'{name}.urdf'
    text = (file if file.exists() else RECORDED / 'robots' / file.name).read_text('utf-8')
    assert old in text
    return text.replace(old, new, 1)


def box_sdf(size, name='box', static=True, more=''):
    """Return a box [m] that weighs 1 kg unless it is static, as SDF."""
    return (
        f'<sdf version="1.6"><model name="{name}"><static>{static}</static><link name="l">'
        f'<collision name="c">{more}<geometry><box><size>{size}</size></box></geometry>'
        '</collision></link></model></sdf>'
    )


CUBE = box_sdf('.02 .02 .02')


def collected(output):
    """Return a list that takes the readings from now on."""
    found = []
    output.connect(found.append)
    return found


def timed(world, output):
    """Return a list that takes the time [ms] and the reading of each update from now on."""
    found = []
    output.connect(lambda reading: found.append((world.clock.now_ns // 1_000_000, reading)))
    return found


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
