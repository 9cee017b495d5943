"""Where ROS packages lie, and the models and files that they offer to the simulator."""

import contextlib
import os
from functools import cache
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import rospkg

from ...sim.core import NotFoundError
from ...sim.resources import FileSearch, ModelSearch, path_directories

_MANIFESTS = ('manifest.xml', 'package.xml')  # of a package; the first one there is counts


def find_package(name: str) -> str | None:
    """Return the directory of the ROS package `name` on ROS_PACKAGE_PATH, or None.

    Crawling the whole path is slow, so it is done once, and again for an unknown package.

    Raises:
        NotFoundError: a manifest on the path is not XML, so that no package can be looked up.
    """
    try:
        return str(_packages().get_path(name))
    except rospkg.ResourceNotFound:
        _packages.cache_clear()
    try:
        return str(_packages().get_path(name))
    except rospkg.ResourceNotFound:
        return None


@cache
def _packages() -> rospkg.RosPack:
    packages = rospkg.RosPack()
    try:
        packages.list()  # looks through the whole path
    except (ElementTree.ParseError, AttributeError) as error:  # the latter: it has no <name>
        raise NotFoundError(
            f'no ROS package can be looked up because a package.xml on ROS_PACKAGE_PATH is broken '
            f'({error}); fix it, or put a file CATKIN_IGNORE beside it'
        ) from error
    return packages


@cache
def exported_directories(attribute: str) -> tuple[str, ...]:
    """Return the paths exported by <gazebo_ros ATTRIBUTE="..."/>, e.g. gazebo_model_path.

    Reading every manifest is slow, so it is done once, when first needed.
    """
    packages, found = _packages(), []
    for name in packages.list():
        folder = packages.get_path(name)
        for value in _exports(folder, attribute):
            found += path_directories(value.replace('${prefix}', folder))
    return tuple(found)


def _exports(package: str, attribute: str) -> list[str]:
    """Return the values that a package's manifest exports under `attribute`.

    Other errors in the manifest, such as an invalid address, are ignored, as rospack does, which
    Gazebo uses.
    """
    for name in _MANIFESTS:
        with contextlib.suppress(OSError):
            text = Path(package, name).read_bytes()
            if attribute.encode() not in text:  # much faster than parsing
                return []
            with contextlib.suppress(ElementTree.ParseError):
                exports = ElementTree.fromstring(text).iterfind('export/gazebo_ros')
                return [value for export in exports if (value := export.get(attribute))]
            return []
    return []


# model:// is looked up along GAZEBO_MODEL_PATH, the packages' exported paths and, as in Gazebo,
# in the user's model folder.
find_model = ModelSearch(
    [
        lambda: path_directories(os.environ.get('GAZEBO_MODEL_PATH', '')),
        lambda: exported_directories('gazebo_model_path'),
        lambda: [os.path.expanduser('~/.gazebo/models')],
    ]
)

# file:// with a relative path, and materials by their name.
find_file = FileSearch(
    [
        lambda: path_directories(os.environ.get('GAZEBO_RESOURCE_PATH', '')),
        lambda: exported_directories('gazebo_media_path'),
    ]
)

SEARCHES: dict[str, Any] = {  # arguments of what reads models and worlds
    'find_file': find_file,
    'find_model': find_model,
    'find_package': find_package,
}
