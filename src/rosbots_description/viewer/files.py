"""A world with what a file describes: a robot on the ground, or a whole world."""

import os
from collections.abc import Mapping
from contextlib import closing

from ..sim import Fault, PhysicsSettings, Pose, World
from ..sim.core import log_fault, reporting_to
from ..sim.description import WORLD
from ..sim.physics import CrashSandbox, make_engine
from ..sim.placement import box_around, placed
from ..sim.resources import MAX_XML_BYTES, parse_xml, read_file, root_tag


def open_sandbox() -> CrashSandbox:
    """Return a sandbox that tests models before they can crash this process.

    It forks this process, so open it before there are threads.
    """
    with closing(make_engine(PhysicsSettings())) as engine:
        return CrashSandbox(engine, make_engine)


def open_file(
    path: str | os.PathLike[str],
    arguments: Mapping[str, str] | None = None,
    sandbox: CrashSandbox | None = None,
) -> World:
    """Open a world with the model of a URDF, xacro or SDF file, or the world of a world file.

    A model stands on a ground plane, its lowest point at z = 0, unless it is fixed to the world.
    What is wrong with the file is among the faults of the world, and not logged.

    Args:
        path: of a file of one's own: xacro is evaluated as upstream does.
        arguments: for a xacro file, by name.
        sandbox: tests a model before it is spawned; a world is not tested.
    Raises:
        SimError: the file cannot be read, or nothing in it can be simulated.
    """
    file = os.fspath(path)
    with reporting_to(_keep):  # before there is a world
        is_world = _is_world(file)
    if is_world:
        world = World.from_file(file, on_fault=_keep)
    else:
        world = World.empty(on_fault=_keep)
        try:
            with reporting_to(world.faults.add):
                _spawn(world, file, arguments or {}, sandbox)
        except BaseException:
            world.close()
            raise
    world.faults.on_fault = log_fault
    return world


def _keep(_fault: Fault) -> None:
    """Leave a fault to the list of the world."""


def _spawn(
    world: World, path: str, arguments: Mapping[str, str], sandbox: CrashSandbox | None
) -> None:
    spec, pose = world.read_model(path, arguments=arguments)
    is_fixed = spec.static or any(joint.parent == WORLD for joint in spec.joints)
    box = None if is_fixed else box_around(spec, pose)
    if box is not None:
        floor = Pose((*pose.position[:2], 0.0), pose.orientation)
        box[:, 2] -= pose.position[2]
        pose = placed(world, floor, box, on_ground=True, beside=False)
    model = world.compile(spec)
    if sandbox is not None:
        sandbox.require(model, world.physics)
    world.spawn(model, spec.name, pose)


def _is_world(path: str) -> bool:
    """Return whether a file has a <world>; what does not exist is looked for as a world."""
    if path.endswith(('.urdf', '.xacro')):
        return False
    if path.endswith('.world') or not os.path.exists(path):
        return True
    text = read_file(path, MAX_XML_BYTES, 'model file')
    return root_tag(text) in ('sdf', 'gazebo') and any(
        child.tag == 'world' for child in parse_xml(text, path)
    )
