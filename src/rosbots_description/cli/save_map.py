"""Front end of the executable save_map: a world as a map for map_server, without SLAM."""

import argparse
import sys
from collections.abc import Sequence

from .gzserver import split_remappings


def parser() -> argparse.ArgumentParser:
    """Return the parser of save_map's options."""
    made = argparse.ArgumentParser(
        prog='save_map',
        description='Write the occupancy grid of a world at a height as '
        'NAME.pgm and NAME.yaml, which map_server reads. Models with '
        'joints, such as robots, are left out.',
    )
    made.add_argument('name', metavar='NAME', help='of the files; may end in .yaml')
    made.add_argument(
        '--world',
        metavar='FILE',
        help='a world file, as gzserver takes it (default: the running world)',
    )
    made.add_argument(
        '--height',
        type=float,
        default=0.2,
        metavar='Z',
        help='of the section above the origin of the world [m] (default: 0.2)',
    )
    made.add_argument(
        '--resolution',
        type=float,
        default=0.05,
        metavar='EDGE',
        help='edge of a cell [m] (default: 0.05)',
    )
    made.add_argument(
        '--margin',
        type=float,
        default=1.0,
        metavar='WIDTH',
        help='free space around everything [m] (default: 1)',
    )
    made.add_argument(
        '--without', nargs='+', default=(), metavar='MODEL', help='leave these models out as well'
    )
    made.add_argument('-f', '--force', action='store_true', help='overwrite files')
    return made


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the map.

    Returns:
        Exit code: 0 done, 1 failed (one sentence says why), 2 wrong usage (by SystemExit).
    """
    own, remappings = split_remappings(sys.argv[1:] if arguments is None else arguments)
    options = parser().parse_args(own)
    # Imported late: help and wrong usage are fast, and need no ROS.
    from ..ros_api.clients import save_map

    return save_map.run(
        options.name,
        options.world,
        remappings,
        save_map.MapOptions(
            options.height, options.resolution, options.margin, tuple(options.without)
        ),
        options.force,
    )
