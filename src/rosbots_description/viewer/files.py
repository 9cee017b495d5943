"""A world with what a file describes: a robot on the ground, or a whole world."""

import logging
import os
from collections.abc import Mapping
from dataclasses import dataclass

from ..sim import Pose, World
from ..sim.core import held_records
from ..sim.description import WORLD
from ..sim.placement import box_around, placed
from ..sim.resources import MAX_XML_BYTES, parse_xml, read_file, root_tag


@dataclass(frozen=True)
class OpenedFile:
    """A world, and what is wrong with its file: sentences with line and cure, the worst first."""

    world: World
    faults: tuple[str, ...]


def open_file(
    path: str | os.PathLike[str], arguments: Mapping[str, str] | None = None
) -> OpenedFile:
    """Open a world with the model of a URDF, xacro or SDF file, or the world of a world file.

    A model stands on a ground plane, its lowest point at z = 0, unless it is fixed to the world.

    Args:
        path: of a file of one's own: xacro is evaluated as upstream does.
        arguments: for a xacro file, by name.
    Raises:
        SimError: the file cannot be read, or nothing in it can be simulated.
    """
    with held_records(logging.WARNING) as records:
        file = os.fspath(path)
        world = World.from_file(file) if _is_world(file) else _with_model(file, arguments or {})
    worst_first = sorted(records, key=lambda record: -record.levelno)
    return OpenedFile(world, tuple(dict.fromkeys(one.getMessage() for one in worst_first)))


def _with_model(path: str, arguments: Mapping[str, str]) -> World:
    world = World.empty()
    try:
        spec, pose = world.read_model(path, arguments=arguments)
        is_fixed = spec.static or any(joint.parent == WORLD for joint in spec.joints)
        box = None if is_fixed else box_around(spec, pose)
        if box is not None:
            floor = Pose((*pose.position[:2], 0.0), pose.orientation)
            box[:, 2] -= pose.position[2]
            pose = placed(world, floor, box, on_ground=True, beside=False)
        world.spawn(spec, spec.name, pose)
    except BaseException:
        world.close()
        raise
    return world


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
