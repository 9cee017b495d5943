"""What several tests need: the article's robot, small models, and worlds that close themselves."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache, partial
from pathlib import Path

import pytest
import xacro

from rosbots_description.sim import plugins  # noqa: F401  registers
from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.description.model_spec import ModelSpec
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.physics.bullet.engine import Engine
from rosbots_description.sim.physics.bullet.tuning import Tuning
from rosbots_description.sim.runtime.empty_world import add_empty_world
from rosbots_description.sim.runtime.world import World

ROOT = Path(__file__).resolve().parents[2]
LIBRARY = ROOT / 'src' / 'rosbots_description'
XACRO = ROOT / 'urdf' / 'rosbots.xacro'
SPAWN_POSE = Pose((0.0, 0.0, 0.5))  # of spawn.launch
SETTLED = 2500  # steps after which the robot has fallen from there and stands


@cache
def robot_urdf(**arguments: str) -> str:
    """Return the URDF text for xacro arguments, with the package found where this file lies."""
    with pytest.MonkeyPatch.context() as patch:
        path = os.pathsep.join([str(ROOT), os.environ.get('ROS_PACKAGE_PATH', '')])
        patch.setenv('ROS_PACKAGE_PATH', path)
        patch.setattr('roslaunch.substitution_args._rospack', None)  # it remembers the path
        return xacro.process_file(str(XACRO), mappings=arguments).toprettyxml(indent=' ')


def package_directory(name: str) -> str | None:
    """Find this package, and no other."""
    return str(ROOT) if name == 'rosbots_description' else None


@cache
def robot_spec() -> ModelSpec:
    """Return the article's robot as `spawn.launch` spawns it."""
    text = robot_urdf()
    return load_urdf(text, 'rosbots', robot_namespace='/', find_package=package_directory)[0]


@contextmanager
def empty_world(tuning: Tuning | None = None) -> Iterator[World]:
    """Open a world with a ground plane; it is closed at the end.

    Args:
        tuning: other choices of the engine than the usual ones.
    """
    world = World(make_engine=partial(Engine, tuning=tuning))
    try:
        add_empty_world(world)
        yield world
    finally:
        world.close()


def urdf_spec(body: str, name: str = 'thing') -> ModelSpec:
    """Return the model of a URDF given by what stands inside <robot>."""
    return load_urdf(f'<robot name="{name}">{body}</robot>', name)[0]


def box_urdf(size: str, mass: float, extra: str = '') -> str:
    """Return a link `box` of `size` 'x y z' [m] with a plain inertia, and what `extra` adds."""
    shape = f'<geometry><box size="{size}"/></geometry>'
    return (
        f'<link name="box"><inertial><mass value="{mass}"/>'
        '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'
        f'<collision>{shape}</collision><visual>{shape}</visual></link>{extra}'
    )
