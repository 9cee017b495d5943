"""Where ROS packages lie."""

from functools import cache

import rospkg


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
