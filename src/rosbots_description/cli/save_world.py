"""Front end of the executable save_world: the running world as a world file."""

import argparse
import sys
from collections.abc import Sequence

from .gzserver import split_remappings


def parser() -> argparse.ArgumentParser:
    """Return the parser of save_world's options."""
    made = argparse.ArgumentParser(
        prog='save_world',
        description='Save the running world as it stands as a world file, which '
        'world_name:=FILE opens again.',
    )
    made.add_argument('file', metavar='FILE', help='ends in .world or .sdf')
    made.add_argument('-f', '--force', action='store_true', help='overwrite a file')
    return made


def main(arguments: Sequence[str] | None = None) -> int:
    """Save the world.

    Returns:
        Exit code: 0 done, 1 failed (one sentence says why), 2 wrong usage (by SystemExit).
    """
    own, remappings = split_remappings(sys.argv[1:] if arguments is None else arguments)
    options = parser().parse_args(own)
    # Imported late: help and wrong usage are fast, and need no ROS.
    from ..ros_api.clients import save_world

    return save_world.run(options.file, options.force, remappings)
