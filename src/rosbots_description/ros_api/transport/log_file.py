"""The log file of a node: where it cannot be written, the node says so and works without.

rospy itself would show no message anywhere where the folder for logs cannot be made, and would end
with a traceback where the file cannot be opened.
"""

import logging
import os
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import rospkg
from rosgraph.names import REMAP
from rosgraph.roslogging import makedirs_with_parent_perms


def log_file(name: str, arguments: Sequence[str]) -> Path:
    """Return where rospy will log: as `__log:=FILE` says, else in ROS_LOG_DIR by the node's name.

    For an anonymous node, whose name nobody knows yet, only the folder is right.
    """
    given = dict(argument.split(REMAP, 1) for argument in arguments if REMAP in argument)
    name = given.get('__name', name).strip('/')
    return Path(rospkg.get_log_dir(), given.get('__log', f'{name}.log')).absolute()


def obstacle(path: Path) -> str | None:
    """Return why the log file cannot be written, or None if it can be; the folder is made."""
    try:
        if not path.parent.is_dir():
            makedirs_with_parent_perms(str(path.parent))
        with tempfile.TemporaryFile(dir=path.parent) as probe:
            probe.write(b'.')
        if path.exists():
            with path.open('ab'):
                pass
    except OSError as error:
        return error.strerror
    return None


def log_to_nowhere() -> list[str]:
    """Return what to add to a node's arguments so that it logs without a file."""
    # rospy insists on a file. Were it not in this very folder, a link /latest would be made.
    os.environ['ROS_LOG_DIR'] = os.path.dirname(os.devnull)
    return [f'__log{REMAP}{os.devnull}']


def outlive_full_disk() -> None:
    """Let the log file take every text, and one warning suffice when it takes nothing more.

    Call it after `init_node`. Python's logging would print a traceback with each message.
    """
    for handler in logging.getLogger().handlers:
        if isinstance(handler, logging.FileHandler):
            handler.encoding, handler.errors = 'utf-8', 'backslashreplace'  # when files rotate
            if handler.stream is not None:
                handler.stream.reconfigure(encoding=handler.encoding, errors=handler.errors)
            handler.handleError = _Complaint(handler)  # type: ignore[method-assign]  # the only way


class _Complaint:
    """Says once that a log file cannot be written any more; other faults are Python's to show."""

    def __init__(self, handler: logging.FileHandler) -> None:
        self._path = handler.baseFilename
        self._show = handler.handleError
        self._said = False

    def __call__(self, record: logging.LogRecord) -> None:
        error = sys.exc_info()[1]
        if not isinstance(error, OSError):
            self._show(record)
        elif not self._said:
            self._said = True
            # Logged, it would come back here.
            sys.stderr.write(f'[WARN] [{time.time():f}]: log file {self._path} cannot be written '
                             f'({error.strerror}); messages may be missing, free some space\n')
