"""Shared fixtures: the article's robot, small models, and worlds as context managers."""

import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache, partial
from pathlib import Path

import pytest

from rosbots_description.sim import plugins  # noqa: F401  registers
from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.description.model_spec import ModelSpec
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.physics.bullet.engine import Engine
from rosbots_description.sim.physics.bullet.tuning import Tuning
from rosbots_description.sim.runtime.empty_world import add_empty_world
from rosbots_description.sim.runtime.world import World
from rosbots_description.sim.xacro_module import import_xacro

ROOT = Path(__file__).resolve().parents[2]
LIBRARY = ROOT / 'src' / 'rosbots_description'
XACRO = ROOT / 'urdf' / 'rosbots.xacro'
SPAWN_POSE = Pose((0.0, 0.0, 0.5))  # of spawn.launch
SETTLED = 2500  # steps until the robot, spawned there, stands on the ground


@cache
def robot_urdf(**arguments: str) -> str:
    """Return the URDF text for xacro arguments; the package is that of this file."""
    with pytest.MonkeyPatch.context() as patch:
        path = os.pathsep.join([str(ROOT), os.environ.get('ROS_PACKAGE_PATH', '')])
        patch.setenv('ROS_PACKAGE_PATH', path)
        patch.setattr('roslaunch.substitution_args._rospack', None)  # it caches the path
        return import_xacro().process_file(str(XACRO), mappings=arguments).toprettyxml(indent=' ')


def package_directory(name: str) -> str | None:
    """Return the folder of this package, None for any other."""
    return str(ROOT) if name == 'rosbots_description' else None


@cache
def robot_spec() -> ModelSpec:
    """Return the article's robot as `spawn.launch` spawns it."""
    text = robot_urdf()
    return load_urdf(text, 'rosbots', robot_namespace='/', find_package=package_directory)[0]


@contextmanager
def empty_world(
    tuning: Tuning | None = None, engine: Callable[..., Engine] = Engine
) -> Iterator[World]:
    """Yield a world with a ground plane; close it at the end.

    Args:
        tuning: engine settings; None for the defaults.
        engine: makes the engine.
    """
    world = World(make_engine=partial(engine, tuning=tuning))
    try:
        add_empty_world(world)
        yield world
    finally:
        world.close()


def urdf_spec(body: str, name: str = 'thing') -> ModelSpec:
    """Return the model of a URDF, given the text inside <robot>."""
    return load_urdf(f'<robot name="{name}">{body}</robot>', name)[0]


def mesh_spec(path: Path, size: float = 1.0) -> ModelSpec:
    """Write a tetrahedron of 1 m, and `size` [m] along x, as an OBJ; return a model of it."""
    path.write_text(
        f'v 0 0 0\nv {size} 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n'
    )
    mesh = f'<mesh filename="file://{path}"/>'
    return urdf_spec(box_urdf('1 1 1', 1.0).replace('<box size="1 1 1"/>', mesh))


def burn(seconds: float) -> None:
    """Use processor time [s]."""
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass


def box_urdf(size: str, mass: float, extra: str = '') -> str:
    """Return a link `box` of `size` 'x y z' [m], followed by the text `extra`."""
    shape = f'<geometry><box size="{size}"/></geometry>'
    return (
        f'<link name="box"><inertial><mass value="{mass}"/>'
        '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'
        f'<collision>{shape}</collision><visual>{shape}</visual></link>{extra}'
    )
