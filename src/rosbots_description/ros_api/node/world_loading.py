"""Find the world file named by `world_name:=`, and read it."""

import os
from collections.abc import Iterator
from pathlib import Path

from ...sim.core import NotFoundError
from ...sim.description import WorldSpec
from ...sim.formats import open_world
from ...sim.resources import find_world, path_directories
from .packages import SEARCHES, exported_directories

_OWN = Path(__file__).resolve().parents[2]  # holds worlds/, wherever this library is installed


def read_world(name: str) -> WorldSpec:
    """Find and read a world file; needs neither a ROS master nor a node.

    The name is a path, absolute or relative to GAZEBO_RESOURCE_PATH, to the included worlds or to a
    gazebo_media_path that a package exports, in this order.

    Raises:
        SimError: there is no such file, or it contains no world.
    """
    return open_world(_find(name), **SEARCHES)


def own_worlds() -> list[str]:
    """Return the names of the included worlds, e.g. 'worlds/empty.world'."""
    return [f'worlds/{path.name}' for path in sorted(_OWN.glob('worlds/*.world'))]


def _find(name: str) -> Path:
    try:
        return find_world(name, _places())
    except NotFoundError as error:
        raise NotFoundError(f'{error}; included worlds: {", ".join(own_worlds())}') from None


def _places() -> Iterator[str]:
    places = [*path_directories(os.environ.get('GAZEBO_RESOURCE_PATH', '')), str(_OWN)]
    yield from places
    for path in exported_directories('gazebo_media_path'):  # slow, so it comes last
        if path not in places:
            yield path
