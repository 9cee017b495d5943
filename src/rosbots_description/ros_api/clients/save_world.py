"""Save the running world in a file of this machine, which need not be the simulator's."""

from __future__ import annotations

import os
from collections.abc import Sequence

from rosbots_msgs.srv import SaveWorld

from ...sim.resources import require_world_path, write_world
from . import service_program
from .service_program import Call, Lines


def run(path: str, overwrite: bool, ros_arguments: Sequence[str]) -> int:
    """Save the world; return the exit code. See `save`."""
    return service_program.run(
        'save_world', lambda call: save(call, path, overwrite), ros_arguments
    )


def save(call: Call, path: str, overwrite: bool) -> Lines:
    """Write the world as it stands to a file, and yield what was done.

    Args:
        path: ends in .world or .sdf.
        overwrite: whether there may be a file already.
    Raises:
        SimError: the file exists or cannot be written.
    """
    path = os.path.abspath(path)
    require_world_path(path)
    answer = call('save_world', SaveWorld)
    write_world(path, answer.sdf, overwrite)
    yield f'{answer.status_message.removeprefix("SaveWorld: ")}: {path}'
