"""Where ROS packages lie, and the models and files that they offer to the simulator."""

import contextlib
import os
from functools import cache
from pathlib import Path

import rospkg

from ..sim.model_search import ModelSearch, path_directories

_MANIFESTS = ('manifest.xml', 'package.xml')  # of a package; the first one there is counts


def find_package(name: str) -> str | None:
    """Return the directory of the ROS package `name` on ROS_PACKAGE_PATH, or None.

    Looking through the whole path takes a while, so it is done once, and again for a package that
    was not there yet.
    """
    try:
        return _packages().get_path(name)
    except rospkg.ResourceNotFound:
        _packages.cache_clear()
    try:
        return _packages().get_path(name)
    except rospkg.ResourceNotFound:
        return None


@cache
def _packages() -> rospkg.RosPack:
    return rospkg.RosPack()


@cache
def exported_directories(attribute: str) -> tuple[str, ...]:
    """Return what packages export by <gazebo_ros ATTRIBUTE="..."/>, e.g. gazebo_model_path.

    Looking at every manifest takes a while, so it is done once, when first needed.
    """
    packages, found = _packages(), []
    for name in packages.list():
        if not _mentions(packages.get_path(name), attribute):
            continue
        try:
            values = packages.get_manifest(name).get_export('gazebo_ros', attribute)
        except rospkg.InvalidManifest:
            continue
        for value in values:
            found += path_directories(value.replace('${prefix}', packages.get_path(name)))
    return tuple(found)


def _mentions(package: str, word: str) -> bool:
    """Tell whether a word stands in a package's manifest, which takes far less than to parse it."""
    for name in _MANIFESTS:
        with contextlib.suppress(OSError):
            return word.encode() in Path(package, name).read_bytes()
    return False


def find_model(inner: str) -> str | None:
    """Return where model://`inner` is, or None.

    It is looked for along GAZEBO_MODEL_PATH, the packages' paths and, as in Gazebo, in the folder
    where users keep models.
    """
    return (
        ModelSearch(path_directories(os.environ.get('GAZEBO_MODEL_PATH', '')))(inner)
        or ModelSearch(exported_directories('gazebo_model_path'))(inner)
        or ModelSearch([os.path.expanduser('~/.gazebo/models')])(inner)
    )
