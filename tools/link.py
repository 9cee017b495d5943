#!/usr/bin/env python3
"""Link this project's packages into a catkin workspace: `./rosbots link WORKSPACE`.

The user's packages have precedence. If the workspace has a package of the same name, ours is not
linked; nor is our robot if an underlying workspace, sourced in the terminal, has a package of that
name. A clone inside the source space is then hidden from catkin by a file CATKIN_IGNORE.
"""

import os
import sys
from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree

from catkin_pkg.packages import find_package_paths

ROOT = Path(__file__).resolve().parents[1]
ROBOT = 'rosbots_description'
HIDE = ROOT / 'CATKIN_IGNORE'


def main() -> int:
    """Link the packages in the first folder into the workspace, and report it."""
    if len(sys.argv) != 3:
        return _complain('link takes one workspace, for example: ./rosbots link ~/catkin_ws')
    ours = {
        folder.name: folder
        for folder in sorted(Path(sys.argv[1]).absolute().iterdir())
        if (folder / 'package.xml').exists()
    }
    ours[ROBOT] = ROOT  # the workspace has only a part of it
    source = Path(sys.argv[2]).absolute() / 'src'
    if not source.is_dir():
        return _complain(f'there is no folder {source}; give the root of a catkin workspace')
    theirs = _find_theirs(source, ours)
    if source.resolve() in ROOT.parents:
        _hide(ROBOT in theirs)
    present = [
        (name, folder)
        for name, folder in _packages(source)
        if name in ours and _is_same(folder, ours[name])
    ]
    for name, folder in present:
        if name in theirs and folder.is_symlink():
            folder.unlink()
    for name in ours.keys() & theirs.keys():
        print(f'{name} is yours, in {theirs[name]}; ours is left out')
    missing = sorted(ours.keys() - theirs.keys() - dict(present).keys())
    for name in missing:
        link = source / name
        if link.exists():
            return _complain(f'{link} is in the way and is not a package of that name')
        link.unlink(missing_ok=True)  # a link to the previous folder of our package
        link.symlink_to(ours[name])
    print(f'linked into {source}: {", ".join(missing) or "nothing new"}')
    return 0


def _find_theirs(source: Path, ours: Mapping[str, Path]) -> dict[str, Path]:
    """Return the user's packages with our names: in `source`; the robot also in underlays."""
    below = [place for place in os.environ.get('ROS_PACKAGE_PATH', '').split(os.pathsep) if place]
    theirs = {
        name: folder
        for place in reversed(below)
        for name, folder in _packages(Path(place))
        if name == ROBOT and not _is_same(folder, ours[ROBOT])
    }
    return theirs | {
        name: folder
        for name, folder in _packages(source)
        if name in ours and not _is_same(folder, ours[name])
    }


def _packages(place: Path) -> list[tuple[str, Path]]:
    """Return name and folder of each package below a folder, as catkin finds them."""
    found = []
    for path in sorted(find_package_paths(str(place))):
        folder = Path(os.path.normpath(place / path))
        try:
            name = ElementTree.parse(folder / 'package.xml').findtext('name', '').strip()
        except (OSError, ElementTree.ParseError):
            continue  # catkin reports the error
        found.append((name, folder))
    return found


def _is_same(one: Path, other: Path) -> bool:
    return os.path.samefile(one / 'package.xml', other / 'package.xml')


def _hide(hidden: bool) -> None:
    """Hide this clone from catkin as a package, or show it again."""
    if hidden:
        HIDE.touch()
    else:
        HIDE.unlink(missing_ok=True)


def _complain(sentence: str) -> int:
    sys.stderr.write(f'rosbots: {sentence}\n')
    return 2


if __name__ == '__main__':
    sys.exit(main())
