"""The article's robot for the benchmarks."""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

from rosbots_description.sim import plugins  # noqa: F401  registers
from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.description.model_spec import ModelSpec
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.runtime.empty_world import add_empty_world
from rosbots_description.sim.runtime.world import World
from rosbots_description.sim.xacro_module import import_xacro

ROOT = Path(__file__).resolve().parents[1]
OUTPUT = ROOT / '.ws' / 'benchmark'  # pictures and logs
FORWARD = 0.5  # [m/s] commanded where only the cost of driving is measured


def robot_urdf(**arguments: str) -> str:
    """Return the URDF text of the article's robot, with absolute paths of the meshes.

    Args:
        arguments: of the xacro file.
    """
    # xacro asks rospack for packages
    os.environ.setdefault('ROS_PACKAGE_PATH', str(ROOT))
    document = import_xacro().process_file(str(ROOT / 'urdf' / 'rosbots.xacro'), mappings=arguments)
    text = document.toprettyxml(indent=' ')
    return str(text.replace('package://rosbots_description', str(ROOT)))


def robot_spec() -> ModelSpec:
    """Return the model specification of the article's robot."""
    return load_urdf(robot_urdf(), 'rosbots', robot_namespace='/')[0]


def kind_urdf(kind: str) -> str:
    """Return the URDF text of a kind of drive: the article's robot, or one recorded in Gazebo.

    The latter get their commands below the namespace in which they are spawned.
    """
    if kind == 'article':
        return robot_urdf()
    text = (ROOT / 'test' / 'data' / 'gazebo' / 'robots' / f'{kind}.urdf').read_text('utf-8')
    return text.replace('<robotNamespace>/</robotNamespace>', '')


@contextlib.contextmanager
def driven_world(robots: int, distance: float, driving: bool) -> Iterator[World]:
    """Yield an empty world with robots side by side, `distance` [m] apart; close it at the end."""
    world = World()
    try:
        add_empty_world(world)
        spec = robot_spec()
        for i in range(robots):
            model = world.spawn(spec, f'robot{i}', Pose((0.0, distance * i, 0.5)))
            model.plugin('diff_drive').command(FORWARD if driving else 0.0, 0.0)
        yield world
    finally:
        world.close()
