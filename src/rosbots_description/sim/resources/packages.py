"""Find ROS packages by name without ROS: a package is a folder with a package.xml."""

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

from .search_path import Directories, path_directories

_MANIFEST = 'package.xml'
# This package itself: its source tree, or the folder of its data as installed by pip.
_OWN = (Path(__file__).resolve().parents[4], Path(sys.prefix, 'share', 'rosbots_description'))


class PackageSearch:
    """Looks for packages; an instance is called with a package's name.

    A package that holds the file `inside` comes first, then those in the given directories, those
    along ROS_PACKAGE_PATH, and rosbots_description itself.
    """

    def __init__(
        self, directories: Directories = (), inside: str | os.PathLike[str] | None = None
    ) -> None:
        """Search these directories, each of which is a package or holds packages at any depth."""
        self._directories = tuple(directories)
        self._inside = None if inside is None else Path(os.path.abspath(inside))

    def __call__(self, name: str) -> str | None:
        """Return the absolute path of the package's folder; None if there is no such package."""
        above = self._inside.parents if self._inside else ()
        likely = (
            folder
            for directory in self.directories()
            for folder in (Path(directory), Path(directory, name))
        )
        for folder in (*above, *likely):
            if package_name(folder) == name:
                return os.path.abspath(folder)
        for directory in self.directories():
            for folder in _packages_in(directory):
                if package_name(folder) == name:
                    return os.path.abspath(folder)
        return next((str(folder) for folder in _OWN if package_name(folder) == name), None)

    def directories(self) -> Iterator[str]:
        """Yield the directories as they are now, in order."""
        for entry in self._directories:
            for path in entry() if callable(entry) else [entry]:
                yield os.fspath(path)
        yield from path_directories(os.environ.get('ROS_PACKAGE_PATH', ''))


def package_name(folder: Path) -> str | None:
    """Return the name that the package.xml of a folder gives; None without a readable one."""
    try:
        text = ElementTree.parse(folder / _MANIFEST).findtext('name')
    except (OSError, ElementTree.ParseError):
        return None
    return text.strip() if text else None


def _packages_in(directory: str) -> Iterator[Path]:
    """Yield the folders with a manifest; as in ROS, none is looked for within another package."""
    for folder, inner, files in os.walk(directory, followlinks=True):
        if _MANIFEST in files:
            inner.clear()
            yield Path(folder)
        elif 'CATKIN_IGNORE' in files:
            inner.clear()
        else:
            inner[:] = sorted(name for name in inner if not name.startswith('.'))
