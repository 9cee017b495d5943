"""The log file of a node, which warns and continues if the file cannot be written.

rospy itself shows no messages at all if the log folder cannot be created, and ends with a traceback
if the file cannot be opened.
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
    """Return the path of rospy's log file: `__log:=FILE`, else ROS_LOG_DIR/<node>.log.

    For an anonymous node, whose name is not known yet, only the folder is correct.
    """
    given = dict(argument.split(REMAP, 1) for argument in arguments if REMAP in argument)
    name = given.get('__name', name).strip('/')
    return Path(rospkg.get_log_dir(), given.get('__log', f'{name}.log')).absolute()


def write_error(path: Path) -> str | None:
    """Return why the log file cannot be written, or None; creates its folder."""
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


def disable_log_file() -> list[str]:
    """Return additional arguments for a node without a log file."""
    # rospy requires a file. Were it outside ROS_LOG_DIR, rospy would create a link /latest.
    os.environ['ROS_LOG_DIR'] = os.path.dirname(os.devnull)
    return [f'__log{REMAP}{os.devnull}']


def tolerate_full_disk() -> None:
    """Let the log file accept all text, and warn once when it cannot be written any more.

    Call it after `init_node`. Python's logging would print a traceback for each message.
    """
    for handler in logging.getLogger().handlers:
        if isinstance(handler, logging.FileHandler):
            handler.encoding, handler.errors = 'utf-8', 'backslashreplace'  # for rotated files
            if handler.stream is not None:
                handler.stream.reconfigure(encoding=handler.encoding, errors=handler.errors)
            handler.handleError = _WriteErrorReporter(handler)  # type: ignore[method-assign]  # the only way


class _WriteErrorReporter:
    """Warns once that a log file cannot be written; passes other errors to Python's handler."""

    def __init__(self, handler: logging.FileHandler) -> None:
        self._path = handler.baseFilename
        self._show = handler.handleError
        self._seen = False

    def __call__(self, record: logging.LogRecord) -> None:
        error = sys.exc_info()[1]
        if not isinstance(error, OSError):
            self._show(record)
        elif not self._seen:
            self._seen = True
            # Logging it would recurse.
            sys.stderr.write(
                f'[WARN] [{time.time():f}]: log file {self._path} cannot be written '
                f'({error.strerror}); messages may be missing, free some space\n'
            )
