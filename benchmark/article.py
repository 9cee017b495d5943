"""The article's robot for the benchmarks."""

import os
from pathlib import Path

import xacro

from rosbots_description.sim.pose import Pose
from rosbots_description.sim.spec import ModelSpec
from rosbots_description.sim.urdf import load_urdf

ROOT = Path(__file__).resolve().parents[1]
SPAWN_POSE = Pose((0.0, 0.0, 0.5))  # of spawn.launch
SETTLED = 2500  # steps after which the robot has fallen from there and stands


def robot_urdf() -> str:
    """Return the URDF text of the article's robot, its meshes as plain paths."""
    os.environ['ROS_PACKAGE_PATH'] = str(ROOT)
    document = xacro.process_file(str(ROOT / 'urdf' / 'rosbots.xacro'), mappings={})
    text = document.toprettyxml(indent=' ')
    return text.replace('package://rosbots_description', str(ROOT))


def robot_spec() -> ModelSpec:
    """Return the article's robot as the simulator takes it."""
    return load_urdf(robot_urdf(), 'rosbots', robot_namespace='/')[0]
